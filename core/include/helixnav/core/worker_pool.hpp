// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace helixnav::core {

/// Threads that share the indices of a loop. Which thread takes which index is left to chance; callers write to places
/// that belong to the index, so that results do not depend on it. One thread: no threads at all. Nothing is allocated by
/// for_each(). A function that throws ends the loop, and for_each() throws the same once no thread is in it any more.
/// Test: core/worker_pool_test.cpp.
class WorkerPool {
 public:
  /// `threads` ≥ 1 in all, the caller's included; fewer where the system gives no more.
  explicit WorkerPool(unsigned threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// f(0) … f(count − 1), in any order, all done on return.
  template <typename Function>
  void for_each(std::size_t count, Function&& f) {
    using Plain = std::remove_reference_t<Function>;
    run({[](void* context, std::size_t i) { (*static_cast<Plain*>(context))(i); },
         const_cast<void*>(static_cast<const void*>(std::addressof(f))), count});
  }

 private:
  struct Job {
    void (*call)(void*, std::size_t) = nullptr;
    void* context = nullptr;
    std::size_t count = 0;
  };
  void run(const Job& job);
  void take_indices(const Job& job);
  void throw_failure();
  void wait_for_jobs();

  std::mutex mutex_;
  std::condition_variable job_given_, job_done_;
  Job job_;
  unsigned generation_ = 0;
  std::size_t busy_ = 0;
  bool stop_ = false;
  std::exception_ptr failure_;  ///< of mutex_
  std::atomic<std::size_t> next_{0};
  std::vector<std::thread> threads_;
};

}  // namespace helixnav::core
