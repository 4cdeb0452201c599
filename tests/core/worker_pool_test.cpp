// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/worker_pool.hpp"

#include <pthread.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace helixnav::core {
namespace {

std::vector<int> squares(WorkerPool& pool, std::size_t count) {
  std::vector<int> values(count, 0);
  pool.for_each(count, [&](std::size_t i) { values[i] = static_cast<int>(i * i); });
  return values;
}

TEST(WorkerPool, DoesEveryIndexOnceWithAnyNumberOfThreads) {
  WorkerPool one(1);
  const std::vector<int> expected = squares(one, 1000);
  EXPECT_EQ(expected[999], 998001);
  for (const unsigned threads : {0u, 2u, 5u}) {
    WorkerPool pool(threads);
    for (int again = 0; again < 20; ++again) EXPECT_EQ(squares(pool, 1000), expected);
  }
}

TEST(WorkerPool, ThrowsWhatTheFunctionThrowsAndGoesOnWorking) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    WorkerPool pool(threads);
    const std::vector<int> expected = squares(pool, 100);
    for (int again = 0; again < 50; ++again) {
      std::atomic<int> under_way{0};
      auto fail_at_seven = [&](std::size_t i) {
        ++under_way;
        const bool fails = i % 10 == 7;
        --under_way;
        if (fails) throw std::runtime_error("index " + std::to_string(i));
      };
      EXPECT_THROW(pool.for_each(100, fail_at_seven), std::runtime_error);
      EXPECT_EQ(under_way, 0) << "a thread is still in the function";
    }
    EXPECT_EQ(squares(pool, 100), expected);
  }
}

/// No thread starts while one of these is alive: it would need more stack than address space.
class NoNewThreads {
 public:
  NoNewThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t huge;
    pthread_attr_init(&huge);
    pthread_attr_setstacksize(&huge, std::size_t{1} << 47);
    worked_ = pthread_setattr_default_np(&huge) == 0;
    pthread_attr_destroy(&huge);
  }
  ~NoNewThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  NoNewThreads(const NoNewThreads&) = delete;
  NoNewThreads& operator=(const NoNewThreads&) = delete;
  bool worked() const { return worked_; }

 private:
  pthread_attr_t before_;
  bool worked_ = false;
};

TEST(WorkerPool, WorksWithTheThreadsThatThereAre) {
  WorkerPool one(1);
  const std::vector<int> expected = squares(one, 1000);
  const NoNewThreads no_more;
  ASSERT_TRUE(no_more.worked());
  ASSERT_THROW(std::thread([] {}).join(), std::system_error) << "the test does not test";
  WorkerPool pool(4);
  EXPECT_EQ(squares(pool, 1000), expected);
}

}  // namespace
}  // namespace helixnav::core
