#include "sinew/sim/workspaces.hpp"

#include <algorithm>

namespace sinew {

std::unique_ptr<Workspace> Workspaces::take(int threads) {
  {
    const std::lock_guard lock(mutex_);
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
