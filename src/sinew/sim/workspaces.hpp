// Workspaces that are lent: for threads that step different states of one model at the same time.
#pragma once

#include <exception>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "sinew/sim/step.hpp"

namespace sinew {

/// Whoever steps borrows a workspace and gives it back, so that two threads never share one, and one thread finds the
/// same again and again. As many are made as are out at the same time. The model must outlive it.
class Workspaces {
 public:
  explicit Workspaces(const Model& model) : model_(model) {}
  ~Workspaces();
  Workspaces(const Workspaces&) = delete;
  Workspaces& operator=(const Workspaces&) = delete;

  class Loan {
   public:
    Loan(Workspaces& owner, int threads) : owner_(owner), threads_(threads), own_(owner.take(threads)) {}
    /// What an exception has left half-way is not lent again.
    ~Loan() {
      if (std::uncaught_exceptions() == exceptions_) owner_.give_back(threads_, std::move(own_));
    }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    Workspace& operator*() { return *own_; }

   private:
    Workspaces& owner_;
    int threads_;
    int exceptions_ = std::uncaught_exceptions();
    std::unique_ptr<Workspace> own_;
  };
  /// Until the loan ends; `threads` share the work of its steps.
  Loan lend(int threads = 1) { return {*this, threads}; }

 private:
  std::unique_ptr<Workspace> take(int threads);
  /// Leaves alone what a process made that this one was forked from: its threads are not here to be joined.
  void forget_forked();
  void give_back(int threads, std::unique_ptr<Workspace> own);

  const Model& model_;
  long process_ = 0;  ///< that made what is idle
  std::mutex mutex_;
  std::vector<std::pair<int, std::unique_ptr<Workspace>>> idle_;
};

}  // namespace sinew
