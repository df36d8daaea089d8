#include "sinew/threads/crew.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>

namespace sinew::threads {

namespace {

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace

Crew::Crew(int size) {
  try {
    for (int i = 1; i < std::min(size, kMost); ++i) helpers_.emplace_back([this] { help(); });
  } catch (const std::system_error&) {  // results do not depend on their number
  }
}

Crew::~Crew() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  wake_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

Crew& Crew::none() {
  static Crew crew;
  return crew;
}

void Crew::work_on(Job& job) {
  for (int i; (i = job.next.fetch_add(1, std::memory_order_relaxed)) < job.count;) {
    try {
      Interruption::check();
      job.call(job.task, i);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!job.failure) job.failure = std::current_exception();
    }
  }
}

void Crew::share(Job& job) {
  {
    const std::lock_guard lock(mutex_);
    job.before = jobs_;
    jobs_ = &job;
    ++open_;
  }
  wake_.notify_all();
  work_on(job);
  {
    const std::lock_guard lock(mutex_);  // whoever helps has said so under it
    Job** at = &jobs_;
    while (*at != &job) at = &(*at)->before;
    *at = job.before;
    --open_;
  }
  while (job.helping.load(std::memory_order_acquire) > 0) {
    Interruption::asked_to_end();  // (helpers see it between two tasks)
    pause();
  }
  if (job.failure) std::rethrow_exception(job.failure);
}

Crew::Job* Crew::open_job() const {
  for (Job* job = jobs_; job; job = job->before) {
    if (job->next.load(std::memory_order_relaxed) < job->count) return job;
  }
  return nullptr;
}

void Crew::help() {
  using Time = std::chrono::steady_clock;
  constexpr std::chrono::microseconds kPatience{1000};
  constexpr int kLooks = 64;  // between two looks at the clock
  Time::time_point last = Time::now();
  while (!end_) {
    if (open_.load(std::memory_order_relaxed) > 0) {
      Job* job = nullptr;
      {
        const std::lock_guard lock(mutex_);
        job = open_job();
        if (job) ++job->helping;
      }
      if (job) {
        const Interruption::Shared shared(job->interruption);
        work_on(*job);
        job->helping.fetch_sub(1, std::memory_order_release);
        last = Time::now();
        continue;
      }
    }
    for (int i = 0; i < kLooks; ++i) pause();
    if (Time::now() - last < kPatience) continue;
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return end_ || open_job(); });
    last = Time::now();
  }
}

}  // namespace sinew::threads
