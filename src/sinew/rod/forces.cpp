#include "sinew/rod/forces.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "sinew/linalg/sized.hpp"
#include "sinew/rod/crossings.hpp"

namespace sinew::rod {

namespace {

using lie::hat;

/// Loads on what lies beyond, summed about the origin: what any number of them does is told by these few sums.
class Beyond {
 public:
  void add(const Vec3& x, const PointLoad& load) {
    const Vec3 moment = x.cross(load.force) + load.moment;
    wrench_.head<3>() += moment;
    wrench_.tail<3>() += load.force;
    const Vec3 weighted = load.weight * x;
    weight_ += load.weight;
    lever_ += weighted;
    if (!load.bends) {
      outside_.head<3>() += moment;
      outside_.tail<3>() += load.force;
    }
    if (load.follower) {
      second_ += x * weighted.transpose();
      carried_.head<3>() += moment;
      carried_.tail<3>() += load.force;
    } else {
      second_ += x * (load.bends ? Vec3(weighted - load.force) : weighted).transpose();
      moment_ += load.moment;
    }
    if (load.stiffness) {
      Eigen::Matrix<double, 3, 6> J;  // of x by a twist
      J << -hat(x), Mat3::Identity();
      add_springs(J.transpose() * *load.stiffness * J);
    }
  }
  void add(const Beyond& other) {
    if (other.sprung_) add_springs(other.springs_);
    wrench_ += other.wrench_;
    weight_ += other.weight_;
    lever_ += other.lever_;
    second_ += other.second_;
    carried_ += other.carried_;
    outside_ += other.outside_;
    moment_ += other.moment_;
  }

  /// Moment, force.
  const Vec6& wrench() const { return wrench_; }
  /// The part of it that takes part in the tangent.
  Vec6 bending() const { return wrench_ - outside_; }

  /// Of coordinates j nearer to the base and k, the second derivatives are T_j^T K T_k and (U T_k)^T T_j; for loads
  /// with a potential U = K. Weights answer the acceleration v + omega x X; a force that stays is moved by it; a wrench
  /// that is carried along does not change with what comes later, and a moment that stays has a later axis turn under
  /// it.
  Mat6 K() const { return sprung(assembled(Vec3(carried_.head<3>()), bending().tail<3>(), carried_.tail<3>())); }
  Mat6 U() const { return sprung(assembled(moment_, bending().tail<3>() - carried_.tail<3>(), Vec3::Zero())); }

  /// Without springs, and of loads that have a potential: what all crossings need of it, as number k of them.
  bool sprung() const { return sprung_; }
  void put(int k, Crossings& crossings) const {
    const Vec6 own = bending();
    const double trace = second_.trace();
    for (int i = 0; i < 3; ++i) {
      crossings.moment[i][k] = wrench_[i];
      crossings.force[i][k] = wrench_[3 + i];
      crossings.bending_moment[i][k] = own[i];
      crossings.bending_force[i][k] = own[3 + i];
      crossings.lever[i][k] = lever_[i];
      for (int j = 0; j < 3; ++j) crossings.turning[j][i][k] = (i == j ? trace : 0.0) - second_(i, j);
    }
    crossings.weight[k] = weight_;
  }

 private:
  void add_springs(const Mat6& more) {
    if (sprung_) {
      springs_ += more;
    } else {
      springs_ = more;
    }
    sprung_ = true;
  }
  Mat6 sprung(Mat6 K) const {
    if (sprung_) K += springs_;
    return K;
  }
  Mat6 assembled(const Vec3& moment, const Vec3& moved, const Vec3& carried) const {
    Mat6 K;
    K.topLeftCorner<3, 3>() = -second_ - hat(moment);
    K.topLeftCorner<3, 3>().diagonal().array() += second_.trace();
    K.topRightCorner<3, 3>() = hat(lever_ - moved);
    K.bottomLeftCorner<3, 3>() = -hat(lever_ + carried);
    K.bottomRightCorner<3, 3>() = weight_ * Mat3::Identity();
    return K;
  }

  Vec6 wrench_ = Vec6::Zero();
  double weight_ = 0.0;          ///< sum w
  Vec3 lever_ = Vec3::Zero();    ///< sum w x
  Mat3 second_ = Mat3::Zero();   ///< sum x (w x - f)^T, f the forces that stay
  Vec6 carried_ = Vec6::Zero();  ///< the wrench of followers
  Vec6 outside_ = Vec6::Zero();  ///< the wrench of loads that stay out of the tangent
  Vec3 moment_ = Vec3::Zero();   ///< sum of the moments that stay
  bool sprung_ = false;
  Mat6 springs_;  ///< sum of stiffnesses, by twists; only if there are any
};

using linalg::Columns;
using linalg::Square;
using linalg::Vector;

/// What a chain of exponentials does to the loads beyond it, as its section's coordinates see it.
template <int M>
struct Crossing {
  explicit Crossing(Eigen::Index m)
      : KT(Columns<M>::Zero(6, m)),
        UT(Columns<M>::Zero(6, m)),
        gradient(Vector<M>::Zero(m)),
        tangent(Square<M>::Zero(m, m)),
        slope(Vector<M>::Zero(m)) {}
  Columns<M> KT, UT;   ///< with T the twists of the coordinates; UT only where it is not KT
  Vector<M> gradient;  ///< T^T wrench
  Square<M> tangent;   ///< of the coordinates among themselves
  // Of a slide: the abscissa of the chain's end is one more coordinate.
  Vec6 Kt = Vec6::Zero(), Ut = Vec6::Zero();  ///< with t its twist
  Vector<M> slope;                            ///< tangent between it and the coordinates
  double second = 0.0;                        ///< its own
};

/// The twists of a piece and what is used twice of them.
struct PieceMotion {
  PieceMotion(const Piece& piece, const Vec3& origin)
      : turn(piece.R * piece.tangent().matrix()), move(piece.R * piece.tangent().gradient(piece.rho)) {
    twists.topLeftCorner<3, 3>() = turn;
    twists.topRightCorner<3, 3>().setZero();
    twists.bottomLeftCorner<3, 3>() = move + hat(piece.end() - origin) * turn;
    twists.bottomRightCorner<3, 3>() = turn;
  }
  Mat3 turn, move;  ///< of its end by phi
  Mat6 twists;
};

/// d(piece twists^T wrench) for a wrench that stays, by the six numbers of the piece; without `stretches` only by the
/// first three of them.
Mat6 local_tangent(const Piece& piece, const PieceMotion& motion, const Vec6& wrench, const Vec3& origin,
                   bool stretches) {
  const Vec3 world = wrench.tail<3>();
  const Vec3 force = piece.R.transpose() * world;
  const Vec3 moment = piece.R.transpose() * (wrench.head<3>() - (piece.end() - origin).cross(world));
  const Mat3 arm = motion.turn.transpose() * hat(world);  // the moment about the end changes as the end moves
  Mat6 H;
  H.topLeftCorner<3, 3>() = piece.tangent().transposed_gradient(moment) +
                            piece.tangent().hessian(piece.rho * force.transpose()) + arm * motion.move;
  if (!stretches) return H;
  const Mat3 mixed = piece.tangent().transposed_gradient(force);
  H.topRightCorner<3, 3>() = mixed.transpose() + arm * motion.turn;
  H.bottomLeftCorner<3, 3>() = mixed;
  H.bottomRightCorner<3, 3>().setZero();
  return H;
}

/// Walks the rod from the tip to the base with the sums of all loads met.
class Walk {
 public:
  Walk(const Configuration& shape, std::span<const PointLoad> loads, Equations& equations)
      : shape_(shape),
        rod_(*shape.rod),
        loads_(loads),
        equations_(equations),
        symmetric_(equations.chain.symmetric()),
        left_(loads.size()) {}

  void run() {
    balance(rod_.length(), shape_.R.back(), shape_.p.back());
    for (int i = rod_.count() - 1; i >= 0; --i) {
      linalg::with_size(rod_.first[i + 1] - rod_.first[i], [&](auto size) { pass_section<decltype(size)::value>(i); });
      balance(rod_.sections[i].begin, shape_.R[i], shape_.p[i]);
    }
    std::reverse(equations_.internal.begin(), equations_.internal.end());
    add_base();
  }

 private:
  void balance(double s, const Mat3& R, const Vec3& p);
  template <int M>
  void pass_section(int i);
  template <int M>
  void meet_loads(int i, int k, bool all);
  template <int M>
  Crossing<M> cross(std::span<const Piece> pieces, int i, const Beyond& beyond, const Weights& weights,
                    const PartialWeights* slide) const;
  template <int M>
  void add(int i, int k, const Crossing<M>& crossing);
  void begin_together(int i);
  template <int M>
  bool cross_together(int i, double length, const Beyond& beyond);
  template <int M>
  void add_together(int i);
  void add_base();

  const Configuration& shape_;
  const Rod& rod_;
  std::span<const PointLoad> loads_;
  Equations& equations_;
  bool symmetric_;
  bool stretches_ = false;  ///< the section's coordinates do
  Beyond beyond_;
  std::size_t left_;  ///< loads not yet met
  Branch branch_;     ///< to the loads at hand

  const RodKernels& kernels_ = rod_kernels();
  double longest_ = 0.0;  ///< exponential of the section that can be crossed with others; 0: none can
  Crossings crossings_{};
};

/// What the loads met so far need at s; called again there, after more of them, only the base's side of it changes.
void Walk::balance(double s, const Mat3& R, const Vec3& p) {
  const Vec3 force = beyond_.wrench().tail<3>();
  const Vec3 moment = beyond_.wrench().head<3>() - (p - shape_.origin).cross(force);
  Vec6 own;
  own << -(R.transpose() * moment), -(R.transpose() * force);
  const double within = std::clamp(s, 0.0, rod_.length());  // sliding points may be a little off the rod's ends
  std::vector<Balance>& all = equations_.internal;
  if (all.empty() || all.back().s != within) all.push_back({within, own, own});
  all.back().before = own;
}

template <int M>
void Walk::pass_section(int i) {
  const Section& section = rod_.sections[i];
  stretches_ = section.stretches();
  begin_together(i);
  for (int k = shape_.first_step[i + 1] - 1; k >= shape_.first_step[i]; --k) {
    const Weights& weights = section.steps[static_cast<std::size_t>(k - shape_.first_step[i])].weights;
    const std::span<const Piece> whole(&shape_.pieces[static_cast<std::size_t>(shape_.steps[k].piece)],
                                       static_cast<std::size_t>(weights.rows()));
    if (!cross_together<M>(i, weights(0, 0), beyond_)) add(i, k, cross<M>(whole, i, beyond_, weights, nullptr));
    meet_loads<M>(i, k, i == 0 && k == 0);
  }
  add_together<M>(i);
}

/// Exponentials of a section of constant strain that does not stretch are crossed together, in the registers' lanes.
void Walk::begin_together(int i) {
  longest_ = symmetric_ && !stretches_ ? longest_exponential(shape_.strains[i]) : 0.0;
  if (longest_ > 0.0) crossings_.from = beginning(shape_.R[i], shape_.p[i] - shape_.origin, shape_.strains[i]);
}

/// Leaves a crossing to be made with others, unless that cannot be.
template <int M>
bool Walk::cross_together(int i, double length, const Beyond& beyond) {
  if (!(std::abs(length) < longest_) || beyond.sprung()) return false;
  if (crossings_.count == kCrossings) add_together<M>(i);
  crossings_.length[crossings_.count] = length;
  beyond.put(crossings_.count++, crossings_);
  return true;
}

template <int M>
void Walk::add_together(int i) {
  if (crossings_.count == 0) return;
  std::fill(crossings_.length + crossings_.count, crossings_.length + kCrossings, 0.0);
  Crossed all;
  kernels_.cross(crossings_, all);
  crossings_.count = 0;
  const std::vector<Mode>& modes = rod_.sections[i].modes;
  for (std::size_t b = 0; b < modes.size(); ++b) {
    const int at = rod_.first[i] + static_cast<int>(b), strain = modes[b].strain;
    equations_.r[rod_.base_coordinates() + at] += all.gradient[strain];
    equations_.chain.V.col(at) += Vec6::Map(all.KT[strain]);
    for (std::size_t a = 0; a < modes.size(); ++a)
      equations_.chain.D(static_cast<Eigen::Index>(a), at) += all.tangent[strain][modes[a].strain];
  }
}

/// Loads that lie in a step, or all that are left.
template <int M>
void Walk::meet_loads(int i, int k, bool all) {
  const Section& section = rod_.sections[i];
  const double begin = section.steps[static_cast<std::size_t>(k - shape_.first_step[i])].begin;
  while (left_ > 0 && (loads_[left_ - 1].s >= begin || all)) {
    // All loads at one abscissa together.
    const PointLoad& last = loads_[left_ - 1];
    const double s = last.s;
    const bool slides = last.slide >= 0;
    const Mat3* R = &branch_.R;
    const Vec3* p = &branch_.p;
    std::span<const Piece> pieces;
    const Weights* weights = &branch_.weights.value;
    if (last.station >= 0) {
      const Configuration::StationFrame& station = shape_.stations[last.station];
      R = &station.R;
      p = &station.p;
      weights = &rod_.stations[last.station].weights;
      if (station.piece >= 0)
        pieces = {&shape_.station_pieces[station.piece], static_cast<std::size_t>(weights->rows())};
    } else {
      branch_in(shape_, i, k, s, branch_);
      pieces = branch_.pieces;
    }
    Beyond here;
    bool jump = false;
    do {
      const PointLoad& load = loads_[--left_];
      here.add(*p + *R * load.offset - shape_.origin, load);
      jump |= !load.spread;
    } while (left_ > 0 && loads_[left_ - 1].s == s && !slides && loads_[left_ - 1].slide < 0);  // each slide by itself
    if (slides || !cross_together<M>(i, (*weights)(0, 0), here)) {
      if (pieces.empty()) {
        branch_in(shape_, i, k, s, branch_);
        pieces = branch_.pieces;
      }
      const Crossing<M> crossing = cross<M>(pieces, i, here, *weights, slides ? &branch_.weights : nullptr);
      add(i, k, crossing);
      if (slides) {
        Slide& slide = equations_.slides[static_cast<std::size_t>(loads_[left_].slide)];
        slide.attachment.link = i;
        slide.attachment.g = crossing.Kt;
        slide.attachment.b = crossing.slope + shape_.steps[k].before.transpose() * crossing.Kt;
        slide.second = crossing.second;
      }
    }
    if (jump) balance(s, *R, *p);
    beyond_.add(here);
    if (jump) balance(s, *R, *p);
  }
}

/// With `slide` the abscissa is one more coordinate, through the weights' derivatives.
template <int M>
Crossing<M> Walk::cross(std::span<const Piece> pieces, int i, const Beyond& beyond, const Weights& weights,
                        const PartialWeights* slide) const {
  const std::vector<Mode>& modes = rod_.sections[i].modes;
  const Coefficients& strains = shape_.strains[i];
  const auto m = static_cast<Eigen::Index>(modes.size());
  const Mat6 K = beyond.K();
  Mat6 U;
  if (!symmetric_) U = beyond.U();
  Crossing<M> crossing(m);
  // From the last piece to the first; KT, UT, Kt and Ut hold those of the later ones.
  for (auto j = static_cast<Eigen::Index>(pieces.size()) - 1; j >= 0; --j) {
    const Piece& piece = pieces[static_cast<std::size_t>(j)];
    const PieceMotion motion(piece, shape_.origin);
    const Mat6 H = local_tangent(piece, motion, beyond.bending(), shape_.origin, stretches_ || slide);
    Columns<M> own(6, m);  // twists by the coordinates
    for (Eigen::Index a = 0; a < m; ++a) {
      const double weight = weights(j, modes[a].degree);
      own.col(a) = weight * motion.twists.col(modes[a].strain);
      for (Eigen::Index b = 0; b < m; ++b)
        crossing.tangent(a, b) += weight * weights(j, modes[b].degree) * H(modes[a].strain, modes[b].strain);
    }
    const Columns<M>& later_U = symmetric_ ? crossing.KT : crossing.UT;
    if (slide) {
      const Vec6 ds = strains * slide->first.row(j).head(strains.cols()).transpose();
      const Vec6 dds = strains * slide->second.row(j).head(strains.cols()).transpose();
      const Vec6 t = motion.twists * ds, Hs = H * ds, force = motion.twists.transpose() * beyond.wrench();
      crossing.second += ds.dot(Hs) + force.dot(dds) + crossing.Ut.dot(t);
      crossing.Kt += K * t;
      crossing.Ut += (symmetric_ ? K : U) * t;
      crossing.second += t.dot(crossing.Kt);
      crossing.slope += own.transpose() * crossing.Kt + later_U.transpose() * t;
      for (Eigen::Index a = 0; a < m; ++a) {
        const Mode& mode = modes[a];
        crossing.slope[a] +=
            weights(j, mode.degree) * Hs[mode.strain] + slide->first(j, mode.degree) * force[mode.strain];
      }
    }
    if (pieces.size() > 1) crossing.tangent.noalias() += later_U.transpose() * own;
    crossing.KT.noalias() += K * own;
    if (!symmetric_) crossing.UT.noalias() += U * own;
    crossing.tangent.noalias() += own.transpose() * crossing.KT;
    crossing.gradient.noalias() += own.transpose() * beyond.wrench();
  }
  return crossing;
}

/// What exponentials do to the loads beyond them, alone and together with the steps of the same section before them;
/// what those do alone follows when their turn comes.
template <int M>
void Walk::add(int i, int k, const Crossing<M>& crossing) {
  linalg::Chain& chain = equations_.chain;
  const Eigen::Index at = rod_.first[i], m = crossing.gradient.size();
  auto D = chain.D.block<M, M>(0, at, m, m);
  D += crossing.tangent;
  equations_.r.segment<M>(rod_.base_coordinates() + at, m) += crossing.gradient;
  chain.V.middleCols<M>(at, m) += crossing.KT;
  if (!symmetric_) chain.U.middleCols<M>(at, m) += crossing.UT;
  if (k == shape_.first_step[i]) return;
  const Columns<M> before = shape_.steps[k].before;
  D.noalias() += before.transpose() * crossing.KT;
  D.noalias() += (symmetric_ ? crossing.KT : crossing.UT).transpose() * before;
}

/// The base's own coordinates: each turns and moves all that come after it.
void Walk::add_base() {
  const auto nb = shape_.base.cols();
  equations_.r.head(nb).noalias() += shape_.base.transpose().lazyProduct(beyond_.wrench());
  const Mat6 K = beyond_.K(), U = beyond_.U();
  for (Eigen::Index i = 0; i < nb; ++i) {
    for (Eigen::Index j = i; j < nb; ++j) {
      equations_.base(i, j) += shape_.base.col(i).dot(K * shape_.base.col(j));
      if (i != j) equations_.base(j, i) += (U * shape_.base.col(j)).dot(shape_.base.col(i));
    }
  }
}

}  // namespace

bool conservative(std::span<const PointLoad> loads) {
  return std::none_of(loads.begin(), loads.end(), [](const PointLoad& load) {
    return !load.moment.isZero(0.0) || (load.follower && !load.force.isZero(0.0));
  });
}

Equations make_equations(const Configuration& shape, bool symmetric, int slides) {
  Equations equations;
  make_equations(shape, symmetric, slides, equations);
  return equations;
}

void make_equations(const Configuration& shape, bool symmetric, int slides, Equations& equations) {
  const Rod& rod = *shape.rod;
  equations.r.setZero(rod.coordinates());
  linalg::make_chain(rod.first, symmetric, equations.chain);
  equations.chain.T = shape.twists;
  equations.base.setZero(rod.base_coordinates(), rod.base_coordinates());
  equations.slides.resize(static_cast<std::size_t>(slides));
  equations.internal.clear();
  equations.internal.reserve(static_cast<std::size_t>(rod.count()) + 1);
}

void add_loads(const Configuration& shape, std::span<const PointLoad> loads, Equations& equations) {
  Walk(shape, loads, equations).run();
}

void add_elasticity(const Rod& rod, const Eigen::VectorXd& q, const Eigen::VectorXd& start, double rate,
                    Equations& equations) {
  for (int i = 0; i < rod.count(); ++i) {
    const Section& section = rod.sections[i];
    linalg::with_size(rod.first[i + 1] - rod.first[i], [&](auto size) {
      constexpr int M = decltype(size)::value;
      const Eigen::Index m = rod.first[i + 1] - rod.first[i], at = rod.base_coordinates() + rod.first[i];
      const auto stiffness = section.stiffness.topLeftCorner<M, M>(m, m);
      const auto damping = section.damping.topLeftCorner<M, M>(m, m);
      const Vector<M> own = q.segment<M>(at, m), flow = rate * (own - start.segment<M>(at, m));
      equations.r.segment<M>(at, m).noalias() += stiffness * own;
      equations.r.segment<M>(at, m).noalias() += damping * flow;
      equations.chain.D.block<M, M>(0, rod.first[i], m, m) += stiffness + rate * damping;
    });
  }
}

Eigen::MatrixXd dense_tangent(const Configuration& shape, const Equations& equations) {
  const Eigen::Index nb = shape.base.cols(), n = equations.chain.coordinates();
  const linalg::Chain& chain = equations.chain;
  Eigen::MatrixXd A(nb + n, nb + n);
  A.topLeftCorner(nb, nb) = equations.base;
  A.topRightCorner(nb, n) = shape.base.transpose() * chain.V;
  A.bottomLeftCorner(n, nb) = (chain.symmetric() ? chain.V : chain.U).transpose() * shape.base;
  A.bottomRightCorner(n, n) = linalg::dense(chain);
  return A;
}

}  // namespace sinew::rod
