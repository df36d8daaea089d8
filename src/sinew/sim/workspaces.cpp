#include "sinew/sim/workspaces.hpp"

#include <unistd.h>

#include <algorithm>

namespace sinew {

Workspaces::~Workspaces() { forget_forked(); }

void Workspaces::forget_forked() {
  const long process = getpid();
  if (process == process_) return;
  for (auto& own : idle_) own.second.release();
  idle_.clear();
  process_ = process;
}

std::unique_ptr<Workspace> Workspaces::take(int threads) {
  {
    const std::lock_guard lock(mutex_);
    forget_forked();
    const auto found =
        std::find_if(idle_.rbegin(), idle_.rend(), [threads](const auto& one) { return one.first == threads; });
    if (found != idle_.rend()) {
      std::unique_ptr<Workspace> own = std::move(found->second);
      idle_.erase(std::next(found).base());
      return own;
    }
  }
  return std::make_unique<Workspace>(model_, threads);
}

void Workspaces::give_back(int threads, std::unique_ptr<Workspace> own) {
  const std::lock_guard lock(mutex_);
  idle_.emplace_back(threads, std::move(own));
}

}  // namespace sinew
