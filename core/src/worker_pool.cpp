// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/worker_pool.hpp"

namespace helixnav::core {

WorkerPool::WorkerPool(unsigned threads) {
  for (unsigned k = 1; k < threads; ++k) threads_.emplace_back([this] { wait_for_jobs(); });
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
  for (std::size_t i = next_.fetch_add(1); i < job.count; i = next_.fetch_add(1)) job.call(job.context, i);
}

void WorkerPool::run(const Job& job) {
  next_.store(0);
  if (threads_.empty() || job.count < 2) {
    take_indices(job);
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
