// Work that ends early: Ctrl-C in a terminal or in Python, a signal of the system, a page that closes.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <thread>

namespace sinew::threads {

/// Leaves work that was interrupted. What it was making is lost; what was there before stays.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

/// While an object of this class lives, the work of the thread that made it can be interrupted: loops call `check`
/// between two iterations, sweeps or tasks. A `Crew` extends it to the threads that help.
class Interruption {
 public:
  /// `asked` says whether the work is to end. Only this thread calls it, every 20 ms at most, from `check`. It must not
  /// throw.
  explicit Interruption(std::function<bool()> asked);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Throws `Interrupted` if the work of the calling thread is to end. Costs a few nanoseconds.
  static void check() {
    if (asked_to_end()) throw Interrupted();
  }
  /// Whether `check` would throw.
  static bool asked_to_end() { return current_ && current_->look(); }

  /// That of the calling thread, if there is one.
  static Interruption* current() { return current_; }

  /// While it lives, the calling thread works for another one and is interrupted with it.
  class Shared {
   public:
    explicit Shared(Interruption* of_other) : before_(current_) { current_ = of_other; }
    ~Shared() { current_ = before_; }
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;

   private:
    Interruption* before_;
  };

 private:
  bool look();

  static thread_local Interruption* current_;
  std::function<bool()> asked_;
  std::atomic<bool> ends_ = false;
  std::thread::id thread_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point last_{};
  Interruption* before_;
};

}  // namespace sinew::threads
