/// A few threads that wait for work. Which thread does what is left open; that results do not depend on it is
/// up to the work: disjoint outputs, sums in a fixed order.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace waymark {

class ThreadPool {
 public:
  /// @param threads number of threads that work, the caller's among them; >= 1. Where the system gives fewer,
  /// these do the work.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls work(0) ... work(count - 1), each once, and returns when all have returned. `work` must not throw.
  void run(int count, const std::function<void(int)>& work);

 private:
  void wait_for_work();
  void take_items();

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  const std::function<void(int)>* work_ = nullptr;
  std::uint64_t round_ = 0;  // of the present run; a worker joins each round once
  int count_ = 0;
  int next_ = 0;
  int busy_ = 0;
  bool stop_ = false;
};

/// Calls work(0) ... work(count - 1), in order where there is no pool.
template <typename Work>
void run_parallel(ThreadPool* pool, int count, const Work& work) {
  if (pool == nullptr || pool->threads() == 1 || count == 1) {
    for (int i = 0; i < count; ++i) work(i);
  } else {
    pool->run(count, std::cref(work));  // a copy would be allocated
  }
}

}  // namespace waymark
