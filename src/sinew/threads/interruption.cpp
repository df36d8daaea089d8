#include "sinew/threads/interruption.hpp"

#include <utility>

namespace sinew::threads {

thread_local Interruption* Interruption::current_ = nullptr;

Interruption::Interruption(std::function<bool()> asked) : asked_(std::move(asked)), before_(current_) {
  current_ = this;
}

Interruption::~Interruption() { current_ = before_; }

bool Interruption::look() {
  constexpr std::chrono::milliseconds kPause{20};
  if (ends_.load(std::memory_order_relaxed)) return true;
  if (std::this_thread::get_id() != thread_) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kPause) return false;
  last_ = now;
  if (!asked_()) return false;
  ends_.store(true, std::memory_order_relaxed);
  return true;
}

}  // namespace sinew::threads
