#include "sinew/rod/forces.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace sinew::rod {

namespace {

using lie::hat;

/// Everything met so far on the way from the tip to the base, about the origin. Of coordinates j nearer to the base and
/// k, the second derivatives are T_j^T K T_k and (U T_k)^T T_j; for loads with a potential U = K.
struct Beyond {
  Vec6 wrench = Vec6::Zero();   ///< moment, force
  Vec6 bending = Vec6::Zero();  ///< the part of it that takes part in the tangent
  Mat6 K = Mat6::Zero(), U = Mat6::Zero();

  void add(const Vec3& x, const Vec3& force, const Vec3& moment, const PointLoad& load) {
    wrench.head<3>() += x.cross(force) + moment;
    wrench.tail<3>() += force;
    const Mat3 X = hat(x), f = load.bends ? hat(force) : Mat3(Mat3::Zero());
    if (load.bends) {
      bending.head<3>() += x.cross(force) + moment;
      bending.tail<3>() += force;
    }
    Mat6 both = Mat6::Zero();
    if (load.weight > 0.0) {
      both.topLeftCorner<3, 3>() -= load.weight * X * X;
      both.topRightCorner<3, 3>() = load.weight * X;
      both.bottomLeftCorner<3, 3>() = -load.weight * X;
      both.bottomRightCorner<3, 3>().diagonal().setConstant(load.weight);
    }
    if (!load.follower) {  // the point moves under a force that stays: (v + omega x x) x f
      both.topLeftCorner<3, 3>() += f * X;
      both.topRightCorner<3, 3>() -= f;
      U.topLeftCorner<3, 3>() -= hat(moment);  // a later coordinate's axis turns under a moment that stays
    } else {                                   // the wrench is carried along; what comes later does not change it
      K.topLeftCorner<3, 3>() += f * X - X * f - hat(moment);
      K.topRightCorner<3, 3>() -= f;
      K.bottomLeftCorner<3, 3>() -= f;
    }
    K += both;
    U += both;
  }
  void add(const Beyond& other) {
    wrench += other.wrench;
    bending += other.bending;
    K += other.K;
    U += other.U;
  }
};

constexpr int kColumns = 6 * (kHighestDegree + 1) + 1;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kColumns>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kColumns, kColumns>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kColumns, 1>;

/// A chain of exponentials as its section's coordinates (and, last, the abscissa of its end) see it.
struct Crossing {
  Columns T;        ///< twists of all its coordinates
  Vector gradient;  ///< T^T wrench
  Square tangent;   ///< of the coordinates among themselves
};

/// d(piece twists^T wrench) for a wrench that stays, by the six numbers of the piece.
Mat6 local_tangent(const Piece& piece, const Vec6& wrench, const Vec3& origin) {
  const Vec3 force = piece.R.transpose() * wrench.tail<3>();
  const Vec3 moment = piece.R.transpose() * (wrench.head<3>() - (piece.end() - origin).cross(Vec3(wrench.tail<3>())));
  const Mat3 V = piece.tangent().matrix();
  const Mat3 mixed = piece.tangent().transposed_gradient(force);
  const Mat3 arm = V.transpose() * hat(force);  // the moment about the end changes as the end moves
  Mat6 H;
  H.topLeftCorner<3, 3>() = piece.tangent().transposed_gradient(moment) +
                            piece.tangent().hessian(piece.rho * force.transpose()) +
                            arm * piece.tangent().gradient(piece.rho);
  H.topRightCorner<3, 3>() = mixed.transpose() + arm * V;
  H.bottomLeftCorner<3, 3>() = mixed;
  H.bottomRightCorner<3, 3>().setZero();
  return H;
}

/// With `slide` the abscissa is one more coordinate of the last column, through the weights' derivatives.
Crossing cross(std::span<const Piece> pieces, const Section& section, const Coefficients& strains, const Vec3& origin,
               const Beyond& beyond, const Weights& weights, const PartialWeights* slide) {
  const auto m = static_cast<Eigen::Index>(section.modes.size());
  const Eigen::Index n = slide ? m + 1 : m;
  Crossing crossing{Columns::Zero(6, n), Vector::Zero(n), Square::Zero(n, n)};
  Columns later_K = Columns::Zero(6, n), later_U = Columns::Zero(6, n);
  for (auto j = static_cast<Eigen::Index>(pieces.size()) - 1; j >= 0; --j) {
    const Piece& piece = pieces[static_cast<std::size_t>(j)];
    const Mat6 twists = piece_twists(piece, origin);
    Columns own(6, n);  // by the coordinates
    for (Eigen::Index c = 0; c < m; ++c)
      own.col(c) = weights(j, section.modes[c].degree) * twists.col(section.modes[c].strain);
    Vec6 ds = Vec6::Zero();
    if (slide) {
      ds = strains * slide->first.row(j).head(strains.cols()).transpose();
      own.col(m) = twists * ds;
    }
    const Columns own_K = beyond.K * own;
    const Mat6 H = local_tangent(piece, beyond.bending, origin);
    for (Eigen::Index a = 0; a < m; ++a) {
      for (Eigen::Index b = 0; b < m; ++b) {
        const Mode &x = section.modes[a], &y = section.modes[b];
        crossing.tangent(a, b) += weights(j, x.degree) * weights(j, y.degree) * H(x.strain, y.strain);
      }
    }
    if (slide) {
      const Vec6 Hs = H * ds, sH = H.transpose() * ds, force = twists.transpose() * beyond.wrench;
      for (Eigen::Index a = 0; a < m; ++a) {
        const Mode& x = section.modes[a];
        const double change = slide->first(j, x.degree) * force[x.strain];
        crossing.tangent(a, m) += weights(j, x.degree) * Hs[x.strain] + change;
        crossing.tangent(m, a) += weights(j, x.degree) * sH[x.strain] + change;
      }
      const Vec6 dds = strains * slide->second.row(j).head(strains.cols()).transpose();
      crossing.tangent(m, m) += ds.dot(Hs) + force.dot(dds);
    }
    crossing.tangent += own.transpose() * (own_K + later_K) + later_U.transpose() * own;
    crossing.gradient += own.transpose() * beyond.wrench;
    crossing.T += own;
    later_K += own_K;
    later_U += beyond.U * own;
  }
  return crossing;
}

}  // namespace

bool conservative(std::span<const PointLoad> loads) {
  return std::none_of(loads.begin(), loads.end(), [](const PointLoad& load) {
    return !load.moment.isZero(0.0) || (load.follower && !load.force.isZero(0.0));
  });
}

Equations make_equations(const Configuration& shape, bool symmetric, int slides) {
  const Rod& rod = *shape.rod;
  std::vector<int> sizes;
  for (const Section& section : rod.sections) sizes.push_back(static_cast<int>(section.modes.size()));
  Equations equations;
  equations.r.setZero(rod.coordinates());
  equations.chain = linalg::make_chain(sizes, symmetric);
  equations.chain.T = shape.twists;
  equations.base.setZero(rod.base_coordinates(), rod.base_coordinates());
  equations.slides.resize(static_cast<std::size_t>(slides));
  equations.internal.setZero(6, 2 * rod.count());
  return equations;
}

void add_loads(const Configuration& shape, std::span<const PointLoad> loads, Equations& equations) {
  const Rod& rod = *shape.rod;
  linalg::Chain& chain = equations.chain;
  const int nb = rod.base_coordinates();
  Beyond beyond;
  std::size_t left = loads.size();  // not yet met
  const auto internal = [&](int i, int column, const Mat3& R, const Vec3& p) {
    const Vec3 force = -R.transpose() * beyond.wrench.tail<3>();
    const Vec3 moment =
        -R.transpose() * (beyond.wrench.head<3>() - (p - shape.origin).cross(Vec3(beyond.wrench.tail<3>())));
    equations.internal.col(2 * i + column) << moment, force;
  };

  for (int i = rod.count() - 1; i >= 0; --i) {
    const Section& section = rod.sections[i];
    const auto m = static_cast<Eigen::Index>(section.modes.size());
    const Coefficients& strains = shape.strains[i];
    auto r = equations.r.segment(nb + rod.first[i], m);
    auto D = chain.block(i);
    auto V = chain.V.middleCols(rod.first[i], m);
    internal(i, 1, shape.R[i + 1], shape.p[i + 1]);

    // What these exponentials do to the loads beyond them, alone and together with the steps of the same section before
    // them; what those do alone follows when their turn comes.
    const auto add = [&](const Crossing& crossing, const Beyond& of, const SectionTwists& before) {
      const Columns T = crossing.T.leftCols(m), VT = of.K * T, UT = of.U * T;
      r += crossing.gradient.head(m);
      D += crossing.tangent.topLeftCorner(m, m) + before.transpose() * VT + UT.transpose() * before;
      V += VT;
      if (!chain.symmetric()) chain.U.middleCols(rod.first[i], m) += UT;
    };

    for (int k = shape.first_step[i + 1] - 1; k >= shape.first_step[i]; --k) {
      const auto& start = shape.steps[k];
      const Step& step = section.steps[static_cast<std::size_t>(k - shape.first_step[i])];
      const std::span<const Piece> whole(&shape.pieces[static_cast<std::size_t>(start.piece)],
                                         static_cast<std::size_t>(step.weights.rows()));
      add(cross(whole, section, strains, shape.origin, beyond, step.weights, nullptr), beyond, start.before);

      while (left > 0 && (loads[left - 1].s >= step.begin || (i == 0 && k == 0))) {
        // All loads at one abscissa together.
        const double s = loads[left - 1].s;
        const Branch own = branch(shape, s);
        Beyond here;
        const bool slides = loads[left - 1].slide >= 0;
        std::size_t number = 0;
        for (; left > 0 && loads[left - 1].s == s; --left) {
          const PointLoad& load = loads[left - 1];
          if ((load.slide >= 0) != slides || (slides && number > 0)) break;  // each slide by itself
          here.add(own.p + own.R * load.offset - shape.origin, load.force, load.moment, load);
          ++number;
        }
        const Crossing crossing =
            cross(own.pieces, section, strains, shape.origin, here, own.weights.value, slides ? &own.weights : nullptr);
        add(crossing, here, start.before);
        if (slides) {
          Slide& slide = equations.slides[static_cast<std::size_t>(loads[left].slide)];
          slide.attachment.link = i;
          slide.attachment.g = here.K * crossing.T.col(m);
          slide.attachment.b = crossing.tangent.col(m).head(m) + start.before.transpose() * slide.attachment.g;
          slide.second = crossing.tangent(m, m);
        }
        beyond.add(here);
      }
    }
    internal(i, 0, shape.R[i], shape.p[i]);
  }

  // The base's own coordinates: each turns and moves all that come after it.
  equations.r.head(nb) += shape.base.transpose() * beyond.wrench;
  for (int i = 0; i < nb; ++i) {
    for (int j = i; j < nb; ++j) {
      equations.base(i, j) += shape.base.col(i).dot(beyond.K * shape.base.col(j));
      if (i != j) equations.base(j, i) += (beyond.U * shape.base.col(j)).dot(shape.base.col(i));
    }
  }
}

void add_elasticity(const Rod& rod, const Eigen::VectorXd& q, const Eigen::VectorXd& start, double rate,
                    Equations& equations) {
  for (int i = 0; i < rod.count(); ++i) {
    const Section& section = rod.sections[i];
    auto r = rod.base_coordinates() + rod.first[i];
    const auto m = static_cast<Eigen::Index>(section.modes.size());
    equations.r.segment(r, m) += section.stiffness * q.segment(r, m);
    equations.chain.block(i) += section.stiffness;
    equations.r.segment(r, m) += rate * (section.damping * (q.segment(r, m) - start.segment(r, m)));
    equations.chain.block(i) += rate * section.damping;
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
