#include "sinew/sim/curve_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sinew {

using Kind = Collider::Kind;
using contact::Simplex;

namespace {

/// The point of a part with these weights, on its true curve if it is a piece of a rod, and the tangent there of what
/// the contact may slide along: zero of a point, at the end of a straight part and at the tips of a rod.
struct LinePoint {
  Vec3 x, tangent = Vec3::Zero();
  double speed = 0.0;          ///< [m] of x per unit of the second weight
  Vec3 second = Vec3::Zero();  ///< [m] second derivative of x over the second weight
};
LinePoint line_point(const Moment& now, const ContactSide& side, const Simplex& placed,
                     const std::array<double, 3>& weights) {
  const bool inside = weights[1] > 0.0 && weights[1] < 1.0;
  if (placed.corners() != 2) {
    Vec3 x = Vec3::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(placed.corners()); ++i) x += weights[i] * placed.x[i];
    return {x};
  }
  if (side.on.kind == Kind::rod) {
    const rod::Configuration& shape = now.rods[side.on.number];
    const double s = abscissa_of(side, weights), length = side.abscissae[1] - side.abscissae[0];
    const rod::CentrePoint point = rod::centre_point(shape, s);
    const bool tip = s <= 0.0 || s >= shape.rod->length();
    return {point.position, tip ? Vec3(Vec3::Zero()) : Vec3(point.derivative.normalized()),
            length * point.derivative.norm(), length * length * point.second};
  }
  const Vec3 along = placed.x[1] - placed.x[0];
  return {placed.x[0] + weights[1] * along, inside ? Vec3(along.normalized()) : Vec3(Vec3::Zero()), along.norm()};
}

/// The second weights that a contact of a line may have: a rod goes on beyond its piece, up to its ends; an edge ends.
struct WeightRange {
  double from = 0.0, to = 1.0;
  bool has(double weight) const { return weight >= from && weight <= to; }
};
WeightRange weight_range(const Moment& now, const ContactSide& side, const Simplex& placed) {
  constexpr double kBeyond = 0.5;  // of the piece: further away another one touches
  if (!is_piece_of_rod(side, placed)) return {};
  const double begin = side.abscissae[0], length = side.abscissae[1] - begin;
  return {std::max(-kBeyond, -begin / length),
          std::min(1.0 + kBeyond, (now.rods[side.on.number].rod->length() - begin) / length)};
}

constexpr double kLiesAlong = 0.3;  ///< of -d . x'' to x'^2, beyond which a rod lies along what it touches
/// Of the determinant to that of lines across each other, where they are side by side all along. (A rod that bends away
/// from a straight edge by much less than a thousandth is still nearest to it at one place.)
constexpr double kSideBySide = 1e-9;

/// Where two parts are nearest within these ranges, one of them a piece of a rod, from where their chords are. With d =
/// x_a(s) - x_b(t), s and t the second weights, Newton's method for min |d|^2 / 2:
///
///     gradient  d . x_a',  -d . x_b';      Hessian  [x_a'^2 + d . x_a'',  -x_a' . x_b';  ., x_b'^2 - d . x_b''],
///
/// that of Gauss and Newton, without d, where it is not positive definite. Steps that do not shorten d are halved.
/// False where a rod lies along a drum of about its own curvature and is equally near all along.
bool nearest_on_curves(const Moment& now, const ContactState& own, const Simplex& a, const Simplex& b,
                       const WeightRange& range_a, const WeightRange& range_b, contact::Nearest& found) {
  constexpr int kMostIterations = 20;
  std::array<double, 3>&s = found.a, &t = found.b;
  double s_nearest = s[1], t_nearest = t[1], distance = INFINITY;
  const auto put = [](std::array<double, 3>& weights, double weight) {
    weights[0] = 1.0 - weight;
    weights[1] = weight;
  };
  const auto step_within = [](const WeightRange& range, double weight, double by) {
    return std::clamp(weight + by, range.from, range.to) - weight;
  };
  for (int i = 0; i < kMostIterations; ++i) {
    const LinePoint first = line_point(now, own.a, a, s), second = line_point(now, own.b, b, t);
    const Vec3 d = first.x - second.x, dx = first.speed * first.tangent, dy = second.speed * second.tangent;
    if (!(d.norm() <= distance * (1.0 + 1e-12))) {
      put(s, std::midpoint(s[1], s_nearest));
      put(t, std::midpoint(t[1], t_nearest));
      continue;
    }
    const double bends_a = d.dot(first.second), bends_b = -d.dot(second.second);
    if (bends_a < -kLiesAlong * first.speed * first.speed || bends_b < -kLiesAlong * second.speed * second.speed)
      return false;
    distance = d.norm();
    s_nearest = s[1];
    t_nearest = t[1];
    const double ab = dx.dot(dy), fa = d.dot(dx), fb = -d.dot(dy);
    double aa = dx.squaredNorm(), bb = dy.squaredNorm();
    const double fa_s = aa + bends_a, fb_t = bb + bends_b;
    if (aa == 0.0 || bb == 0.0 || fa_s * fb_t - ab * ab > kSideBySide * fa_s * fb_t) {
      aa = aa > 0.0 ? fa_s : 0.0;
      bb = bb > 0.0 ? fb_t : 0.0;
    }
    // If one weight is clamped, the other is minimised again; lines side by side are minimised in turn.
    double ds = 0.0, dt = 0.0;
    if (const double determinant = aa * bb - ab * ab; determinant > kSideBySide * aa * bb)
      ds = step_within(range_a, s[1], -(bb * fa + ab * fb) / determinant);
    if (bb > 0.0) dt = step_within(range_b, t[1], (ab * ds - fb) / bb);
    if (aa > 0.0) ds = step_within(range_a, s[1], (ab * dt - fa) / aa);
    put(s, s[1] + ds);
    put(t, t[1] + dt);
    if (std::abs(ds) + std::abs(dt) < 1e-12) return true;
  }
  put(s, s_nearest);
  put(t, t_nearest);
  return true;
}

/// The normal of a rod's point on a face, perpendicular to the rod. A smooth rod touches a flat face with its tangent
/// in it; a point that does not is one beside an edge, round which the rod bends, and no normal force pulls along a
/// rod.
void face_across(const Moment& now, const ContactSide& side, double radius, const Simplex& face,
                 contact::Nearest& found) {
  constexpr double kSteepest = 0.5;  // sine of the angle of rod and face beyond which its end hits, not its side
  const rod::Configuration& shape = now.rods[side.on.number];
  const double s = side.abscissae[0];
  if (s <= 0.0 || s >= shape.rod->length()) return;
  const rod::CentrePoint point = rod::centre_point(shape, s);
  const Vec3 tangent = point.derivative.normalized();
  const double along = tangent.dot(found.normal);
  if (std::abs(along) > kSteepest) return;
  const double cosine = std::sqrt(1.0 - along * along);
  const Vec3 normal = (found.normal - along * tangent) / cosine;
  const double distance = (found.gap + radius) / cosine;
  if (face.kind == Simplex::Kind::triangle) {  // where the line along the normal meets it, if it does
    const Vec3 d = face.x[1] - face.x[0], e = face.x[2] - face.x[0], up = d.cross(e),
               to = point.position - distance * normal - face.x[0];
    const double size = up.squaredNorm(), u = to.cross(e).dot(up) / size, v = d.cross(to).dot(up) / size;
    if (!(std::min({u, v, 1.0 - u - v}) >= 0.0)) return;
    found.b = {1.0 - u - v, u, v};
  }
  found.normal = normal;
  found.gap = distance - radius;
}

}  // namespace

bool is_piece_of_rod(const ContactSide& side, const Simplex& placed) {
  return side.on.kind == Kind::rod && placed.corners() == 2;
}

bool refine_place(const Moment& now, const ContactState& own, const Simplex& a, const Simplex& b,
                  contact::Nearest& found) {
  const auto leaves = [&now](const ContactSide& side, const Simplex& placed, double on_chord, double weight) {
    if (placed.corners() != 2) return false;
    const auto inside = [](double value, double from, double to) { return from < value && value < to; };
    const bool within_piece = inside(weight, 0.0, 1.0);
    if (!is_piece_of_rod(side, placed)) return inside(on_chord, 0.0, 1.0) && !within_piece;
    const WeightRange range = weight_range(now, side, placed);
    return !within_piece && !inside(weight, range.from, range.to);
  };
  const contact::Nearest on_chords = found;
  const bool one_place =
      nearest_on_curves(now, own, a, b, weight_range(now, own.a, a), weight_range(now, own.b, b), found);
  if (one_place && !leaves(own.a, a, on_chords.a[1], found.a[1]) && !leaves(own.b, b, on_chords.b[1], found.b[1]))
    return true;
  found = on_chords;
  if (!nearest_on_curves(now, own, a, b, {}, {}, found)) found = on_chords;
  return !one_place;
}

// With y = x_a(s) - x_b(t), d = |y| least over s and t, e = dy/d(s, t) and v, w how the rod's point moves and turns,
//     d2gap = (P - B^T G^-1 B) / d,    B = e^T dy + d n . de,    G = e^T e + y . d2y/d(s, t)2,
// where P takes what is along n from dy = +-v, and de = +-w x e of the rod's own line.
rod::Mat6 curve_gap_hessian(const Moment& now, const ContactState& own, const Simplex& a, const Simplex& b,
                            const contact::Nearest& found) {
  rod::Mat6 H = rod::Mat6::Zero();
  const double d = found.gap + a.radius + b.radius;
  if (!(d > 1e-9 * now.model.size)) return H;
  const Vec3& n = found.normal;
  const LinePoint first = line_point(now, own.a, a, found.a), second = line_point(now, own.b, b, found.b);
  const auto bend = [](const LinePoint& own_line) {
    return own_line.tangent.isZero(0.0) ? Vec3(Vec3::Zero()) : Vec3(own_line.second / own_line.speed / own_line.speed);
  };
  const bool of_a = own.a.on.kind == Kind::rod;
  Eigen::Matrix2d G;
  G << 1.0 + d * n.dot(bend(first)), -first.tangent.dot(second.tangent), 0.0, 1.0 - d * n.dot(bend(second));
  G(1, 0) = G(0, 1);
  for (int i = 0; i < 2; ++i) {
    if (G(i, i) < 1.0 - kLiesAlong) G(i, i) = 1.0;  // its place stays on the chord: only the tangent there counts
  }
  if (!(G.determinant() > kSideBySide * G(0, 0) * G(1, 1))) return H;
  Eigen::Matrix<double, 2, 6> B = Eigen::Matrix<double, 2, 6>::Zero();
  const double sign = of_a ? 1.0 : -1.0;
  B.row(0).tail<3>() = sign * first.tangent;
  B.row(1).tail<3>() = -sign * second.tangent;
  B.row(of_a ? 0 : 1).head<3>() = sign * d * (of_a ? first : second).tangent.cross(n);
  H.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() - n * n.transpose();
  H -= B.transpose() * G.inverse() * B;
  return H / d;
}

Feet follow_curves(const Moment& now, const ContactState& own, const Simplex& a, const Simplex& b,
                   contact::Nearest& found) {
  const bool curved_a = is_piece_of_rod(own.a, a), curved_b = is_piece_of_rod(own.b, b);
  const bool goes_on = (curved_a || curved_b) && refine_place(now, own, a, b, found);
  const LinePoint first = line_point(now, own.a, a, found.a), second = line_point(now, own.b, b, found.b);
  if (!curved_a && !curved_b) {
    if (own.a.on.kind == Kind::rod && (b.kind == Simplex::Kind::plane || b.kind == Simplex::Kind::triangle))
      face_across(now, own.a, a.radius, b, found);
    return {first.x, second.x};
  }
  constexpr double kParallel = 0.05;  // sine of the angle below which two lines are side by side
  const Vec3 &t = first.tangent, &u = second.tangent, apart = first.x - second.x, both = t.cross(u);
  Vec3 n = found.normal;
  if (const double distance = apart.norm(); distance > 1e-9 * now.model.size)
    n = apart.dot(n) < 0.0 ? Vec3(-apart / distance) : Vec3(apart / distance);
  found.normal = n;
  found.gap = n.dot(apart) - a.radius - b.radius;
  Feet feet{first.x, second.x};
  if (both.norm() > kParallel) {
    n = both.dot(n) < 0.0 ? Vec3(-both.normalized()) : Vec3(both.normalized());
    const double along = t.dot(u), d = apart.dot(t), e = apart.dot(u), determinant = 1.0 - along * along;
    feet.a -= (d - along * e) / determinant * t;
    feet.b += (e - along * d) / determinant * u;
  } else {
    for (const Vec3& line : {t, u}) n -= line.dot(n) * line;
    if (!(n.norm() > 1e-6)) return feet;
    n.normalize();
    if (!t.isZero()) {
      feet.a -= apart.dot(t) * t;
    } else {
      feet.b += apart.dot(u) * u;
    }
  }
  // The tangent stands for the curve near its point alone, and edges and rods end: a foot beyond that is none.
  const WeightRange range_a = goes_on ? weight_range(now, own.a, a) : WeightRange{},
                    range_b = goes_on ? weight_range(now, own.b, b) : WeightRange{};
  if (!range_a.has(found.a[1] + t.dot(feet.a - first.x) / std::max(first.speed, 1e-300)) ||
      !range_b.has(found.b[1] + u.dot(feet.b - second.x) / std::max(second.speed, 1e-300)))
    return {first.x, second.x};
  found.normal = n;
  found.gap = n.dot(feet.a - feet.b) - a.radius - b.radius;
  return feet;
}

}  // namespace sinew
