#include "sinew/rod/forces.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/linalg/sized.hpp"
#include "sinew/rod/beyond.hpp"
#include "sinew/rod/together.hpp"

namespace sinew::rod {

namespace {

using lie::hat;

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
  Walk(const Configuration& shape, std::span<const PointLoad> loads, const Inertia& inertia, Equations& equations)
      : shape_(shape),
        rod_(*shape.rod),
        loads_(loads),
        inertia_(inertia),
        equations_(equations),
        symmetric_(equations.chain.symmetric()),
        left_(loads.size()),
        stations_left_(inertia.stations.size()),
        together_(shape, inertia, equations) {}

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
  void meet_all(int i, int k, bool all);
  template <int M>
  void meet_loads(int i, int k);
  template <int M>
  void meet_station(int i, int k);
  template <int M>
  Crossing<M> cross(std::span<const Piece> pieces, int i, const Beyond& beyond, const Weights& weights,
                    const PartialWeights* slide) const;
  template <int M>
  void add(int i, int k, const Crossing<M>& crossing);
  void add_base();

  const Configuration& shape_;
  const Rod& rod_;
  std::span<const PointLoad> loads_;
  const Inertia& inertia_;
  Equations& equations_;
  bool symmetric_;
  bool stretches_ = false;  ///< the section's coordinates do
  Beyond beyond_;
  std::size_t left_, stations_left_;  ///< loads and stations not yet met
  Branch branch_;                     ///< to the loads at hand
  Together together_;
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
  together_.begin(i, stations_left_);
  for (int k = shape_.first_step[i + 1] - 1; k >= shape_.first_step[i]; --k) {
    const Weights& weights = section.steps[static_cast<std::size_t>(k - shape_.first_step[i])].weights;
    const std::span<const Piece> whole(&shape_.pieces[static_cast<std::size_t>(shape_.steps[k].piece)],
                                       static_cast<std::size_t>(weights.rows()));
    if (!together_.cross(i, weights(0, 0), beyond_)) add(i, k, cross<M>(whole, i, beyond_, weights, nullptr));
    meet_all<M>(i, k, i == 0 && k == 0);
  }
  together_.end(i);
}

/// What lies in a step, or all that is left, from its end to its beginning.
template <int M>
void Walk::meet_all(int i, int k, bool all) {
  const double begin = rod_.sections[i].steps[static_cast<std::size_t>(k - shape_.first_step[i])].begin;
  const double from = all ? -INFINITY : begin;
  for (;;) {
    const double load = left_ > 0 ? loads_[left_ - 1].s : -INFINITY;
    const double station = stations_left_ > 0 ? rod_.stations[stations_left_ - 1].s : -INFINITY;
    if (!(std::max(load, station) >= from) || left_ + stations_left_ == 0) return;
    if (stations_left_ > 0 && station >= load) {
      meet_station<M>(i, k);
    } else {
      meet_loads<M>(i, k);
    }
  }
}

template <int M>
void Walk::meet_station(int i, int k) {
  const std::size_t number = --stations_left_;
  if (together_.meet(number, beyond_)) return;
  const Station& station = rod_.stations[number];
  branch_to(shape_, station, branch_);
  Mat3 Q;
  Q << branch_.p - shape_.origin, branch_.R.rightCols<2>();
  Beyond here;
  here.add(Q, inertia_.stations[number], inertia_.bends);
  equations_.acting += (here.wrench().tail<3>() + station.spread(0, 0) * inertia_.gravity).norm();
  add(i, k, cross<M>(branch_.pieces, i, here, station.weights, nullptr));
  beyond_.add(here);
}

/// Those at one abscissa together, but each slide by itself.
template <int M>
void Walk::meet_loads(int i, int k) {
  const PointLoad& last = loads_[left_ - 1];
  const double s = last.s;
  const bool slides = last.slide >= 0, known = last.at.has_value();
  if (!known) branch_in(shape_, i, k, s, branch_);
  const Mat3& R = known ? last.at->R : branch_.R;
  const Vec3& p = known ? last.at->position : branch_.p;
  Beyond here;
  bool jump = false;
  do {
    const PointLoad& load = loads_[--left_];
    here.add(p + R * load.offset - shape_.origin, load);
    jump |= !load.spread;
  } while (left_ > 0 && loads_[left_ - 1].s == s && !slides && loads_[left_ - 1].slide < 0);
  if (slides || !together_.cross(i, s - rod_.sections[i].begin, here)) {
    if (known) branch_in(shape_, i, k, s, branch_);
    const Crossing<M> crossing =
        cross<M>(branch_.pieces, i, here, branch_.weights.value, slides ? &branch_.weights : nullptr);
    add(i, k, crossing);
    if (slides) {
      Slide& slide = equations_.slides[static_cast<std::size_t>(loads_[left_].slide)];
      slide.attachment.link = i;
      slide.attachment.g = crossing.Kt;
      slide.attachment.b = crossing.slope + shape_.steps[k].before.transpose() * crossing.Kt;
      slide.second = crossing.second;
    }
  }
  if (jump) balance(s, R, p);
  beyond_.add(here);
  if (jump) balance(s, R, p);
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
  equations.acting = 0.0;
  equations.internal.reserve(static_cast<std::size_t>(rod.count()) + 1);
}

void add_loads(const Configuration& shape, std::span<const PointLoad> loads, Equations& equations) {
  add_loads(shape, loads, Inertia{}, equations);
}

void add_loads(const Configuration& shape, std::span<const PointLoad> loads, const Inertia& inertia,
               Equations& equations) {
  Walk(shape, loads, inertia, equations).run();
}

std::optional<Slide> slide_at(const Configuration& shape, const CurvePoint& point, const Vec3& force) {
  if (shape.strains[point.section].cols() > 1 || shape.rod->sections[point.section].stretches()) return {};
  Slide slide;
  const Vec3 turning = point.derivative.cross(force);
  slide.attachment.link = point.section;
  slide.attachment.g << turning, Vec3::Zero();
  slide.attachment.b = point.twists.topRows<3>().transpose() * turning;
  slide.second = force.dot(point.second);
  return slide;
}

void station_inertia(const Rod& rod, const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities, double rate,
                     const Vec3& gravity, const Vec3& origin, std::vector<StationInertia>& inertia) {
  inertia.resize(rod.stations.size());
  for (std::size_t k = 0; k < rod.stations.size(); ++k) {
    const Station& station = rod.stations[k];
    StationInertia& own = inertia[k];
    own.weight = rate * rate * station.spread;
    own.pull.setZero();
    for (int i = station.first_mass; i < station.first_mass + station.masses; ++i) {
      const MassPoint& mass = rod.masses[static_cast<std::size_t>(i)];
      const Vec3 b = mass.mass * (rate * (rate * (positions.col(i) - origin) + velocities.col(i)) + gravity);
      own.pull.col(0) += b;
      own.pull.col(1) += mass.offset.y() * b;
      own.pull.col(2) += mass.offset.z() * b;
    }
  }
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
  A.bottomLeftCorner(n, nb) = chain.left().transpose() * shape.base;
  A.bottomRightCorner(n, n) = linalg::dense(chain);
  return A;
}

}  // namespace sinew::rod
