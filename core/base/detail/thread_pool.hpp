/// A few threads that wait for work. Any thread may do any part of it. So the work must ensure that
/// results do not depend on the thread: its outputs are disjoint, and sums have a fixed order.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

class ThreadPool {
 public:
  /// @param threads number of working threads including the caller's; >= 1. If the system gives
  /// fewer, these do all the work.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls work(0) ... work(count - 1), each once. Returns after all of them have returned. If some
  /// throw, the first exception is thrown here, and work that had not begun is left out.
  void run(int count, const std::function<void(int)>& work);

 private:
  void wait_for_work();
  void take_items();

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  const std::function<void(int)>* work_ = nullptr;
  std::exception_ptr failure_;
  std::uint64_t round_ = 0;  // number of the current run; a worker joins each round once
  int count_ = 0;
  int next_ = 0;
  int busy_ = 0;
  bool stop_ = false;
};

/// Calls work(0) ... work(count - 1). Without a pool it calls them in order.
template <typename Work>
void run_parallel(ThreadPool* pool, int count, const Work& work) {
  if (pool == nullptr || pool->threads() == 1 || count == 1) {
    for (int i = 0; i < count; ++i) work(i);
  } else {
    pool->run(count, std::cref(work));  // a copy would allocate
  }
}

}  // namespace waymark
