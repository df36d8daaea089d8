// Threads that wait for work and share it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "sinew/threads/interruption.hpp"

namespace sinew::threads {

/// The thread that asks, and helpers. Helpers look for work for a millisecond after the last, then sleep. One thread
/// may ask at a time, and each task in turn for its own.
class Crew {
 public:
  static constexpr int kMost = 64;
  /// `size` threads in all, the one that asks included, from 1 to kMost; fewer where the system gives no more.
  explicit Crew(int size = 1);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  int size() const { return static_cast<int>(helpers_.size()) + 1; }

  /// Calls task(0) .. task(count - 1), each once, on any thread and in any order, and returns when all are done. What
  /// they compute must not depend on who does it, or when. The first exception is thrown again here. Between two tasks
  /// the work can be interrupted.
  template <class Task>
  void each(int count, const Task& task) {
    if (count <= 1 || helpers_.empty()) {
      for (int i = 0; i < count; ++i) {
        Interruption::check();
        task(i);
      }
      return;
    }
    Job job;
    job.count = count;
    job.task = &task;
    job.call = [](const void* own, int i) { (*static_cast<const Task*>(own))(i); };
    share(job);
  }

  /// A crew of one.
  static Crew& none();

 private:
  struct Job {
    const void* task = nullptr;
    void (*call)(const void*, int) = nullptr;
    int count = 0;
    Interruption* interruption = Interruption::current();
    std::atomic<int> next{0};
    std::atomic<int> helping{0};
    std::exception_ptr failure;  ///< guarded by the crew's mutex
    Job* before = nullptr;
  };
  void share(Job& job);
  void work_on(Job& job);
  void help();
  /// A job with tasks left; the caller holds the mutex.
  Job* open_job() const;

  std::mutex mutex_;
  std::condition_variable wake_;
  Job* jobs_ = nullptr;       ///< the last one first
  std::atomic<int> open_{0};  ///< how many there are: what helpers watch without the mutex
  std::atomic<bool> end_{false};
  std::vector<std::thread> helpers_;
};

}  // namespace sinew::threads
