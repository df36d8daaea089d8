// CHOLMOD's supernodal factorisation: what the engine's own is compared with, in benchmarks only.
#pragma once

#include <cholmod.h>
#include <dlfcn.h>
#include <unistd.h>

#include <Eigen/CholmodSupport>
#include <cstdio>
#include <cstdlib>

#include "sinew/linalg/sparse_factor.hpp"

namespace sinew {

/// Ends the program unless CHOLMOD's dense work is done by OpenBLAS: with the reference BLAS, which suitesparse is
/// content with, it takes half as long again, and ratios to it would flatter.
inline void need_openblas() {
  if (dlsym(RTLD_DEFAULT, "openblas_get_config")) return;
  std::fputs("CHOLMOD runs on a BLAS that is not OpenBLAS here: scripts/install_dependencies bench\n", stderr);
  std::exit(1);
}

/// Starts the program again with one thread everywhere: libraries read these when they are loaded. CHOLMOD asks OpenMP
/// for four threads whatever OMP_NUM_THREADS says, and on fewer processors they wait for each other; only the limit
/// binds it.
inline void one_thread(char** argv) {
  need_openblas();
  if (std::getenv("OMP_THREAD_LIMIT")) return;
  for (const char* name : {"OMP_THREAD_LIMIT", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"}) setenv(name, "1", 1);
  execv("/proc/self/exe", argv);
}

class Cholmod {
 public:
  using Matrix = linalg::SparseFactor::Matrix;
  enum class Ordering { own_choice, metis };

  /// The lower triangle of a matrix, which must outlive this.
  explicit Cholmod(const Matrix& A, Ordering ordering = Ordering::own_choice)
      : A_(Eigen::viewAsCholmod(A.selfadjointView<Eigen::Lower>())) {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SUPERNODAL;
    if (ordering == Ordering::metis) {
      common_.nmethods = 1;
      common_.method[0].ordering = CHOLMOD_METIS;
    }
    factor_ = cholmod_analyze(&A_, &common_);
  }
  ~Cholmod() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  bool factor() {
    cholmod_factorize(&A_, factor_, &common_);
    return common_.status == CHOLMOD_OK;
  }
  double entries() const { return common_.lnz; }
  /// [bytes] of a supernodal factor.
  double memory() const { return static_cast<double>(factor_->xsize * sizeof(double) + factor_->ssize * sizeof(int)); }

 private:
  cholmod_common common_{};
  cholmod_sparse A_;
  cholmod_factor* factor_ = nullptr;
};

}  // namespace sinew
