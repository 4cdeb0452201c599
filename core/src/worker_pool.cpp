// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/worker_pool.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace helixnav::core {

WorkerPool::WorkerPool(unsigned threads) {
  threads_.reserve(std::max(1u, threads) - 1);
  try {
    for (unsigned k = 1; k < threads; ++k) threads_.emplace_back([this] { wait_for_jobs(); });
  } catch (const std::exception&) {
    // The system gives no more threads: those that exist do the work.
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  job_given_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::take_indices(const Job& job) {
  try {
    for (std::size_t i = next_.fetch_add(1); i < job.count; i = next_.fetch_add(1)) job.call(job.context, i);
  } catch (...) {
    next_.store(job.count);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
  }
}

void WorkerPool::throw_failure() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void WorkerPool::run(const Job& job) {
  next_.store(0);
  if (threads_.empty() || job.count < 2) {
    take_indices(job);
    throw_failure();
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    job_ = job;
    ++generation_;
    busy_ = threads_.size();
  }
  job_given_.notify_all();
  take_indices(job);
  std::unique_lock<std::mutex> lock(mutex_);
  job_done_.wait(lock, [this] { return busy_ == 0; });
  throw_failure();
}

void WorkerPool::wait_for_jobs() {
  unsigned seen = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    job_given_.wait(lock, [&] { return stop_ || generation_ != seen; });
    if (stop_) return;
    seen = generation_;
    const Job job = job_;
    lock.unlock();
    take_indices(job);
    lock.lock();
    if (--busy_ == 0) job_done_.notify_one();
  }
}

}  // namespace helixnav::core
