#include "sinew/contact/hull.hpp"

#include <libqhull_r/libqhull_r.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace sinew::contact {

namespace {

/// One run of Qhull, which tells what is wrong in a file.
class Qhull {
 public:
  /// False where there is no hull.
  bool run(std::vector<double>& coordinates, const char* options) {
    const auto count = static_cast<int>(coordinates.size() / 3);
    return qh_new_qhull(&own_, 3, count, coordinates.data(), False, const_cast<char*>(options), nullptr, messages_) ==
           0;
  }
  Qhull() { qh_zero(&own_, messages_); }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    qh_freeqhull(&own_, !qh_ALL);
    int pieces = 0, bytes = 0;
    qh_memfreeshort(&own_, &pieces, &bytes);
    if (messages_) std::fclose(messages_);
  }

  /// Visits the outward normal of every face and the numbers of its corners, in no order.
  template <class Visit>
  void each_face(const Visit& visit) {
    std::vector<int> corners;
    for (const facetT* facet = own_.facet_list; facet && facet->next; facet = facet->next) {
      corners.clear();
      for (const setelemT* vertex = facet->vertices->e; vertex->p; ++vertex)
        corners.push_back(qh_pointid(&own_, static_cast<vertexT*>(vertex->p)->point));
      visit(Vec3(Eigen::Map<const Vec3>(facet->normal)), corners);
    }
  }

 private:
  qhT own_;
  std::FILE* messages_ = std::tmpfile();
};

/// Nothing where there is no hull.
std::optional<Polyhedron> hull_with(const std::vector<Vec3>& points, const char* options) {
  std::vector<double> coordinates;
  for (const Vec3& p : points) coordinates.insert(coordinates.end(), p.begin(), p.end());
  Qhull qhull;
  if (points.size() < 4 || !qhull.run(coordinates, options)) return std::nullopt;
  std::map<int, int> number;  // of each point that is a corner
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces;
  qhull.each_face([&](const Vec3& n, const std::vector<int>& around) {
    std::vector<int>& face = faces.emplace_back();
    Vec3 middle = Vec3::Zero();
    for (const int point : around) {
      const auto [entry, fresh] = number.try_emplace(point, static_cast<int>(corners.size()));
      if (fresh) corners.push_back(points[static_cast<std::size_t>(point)]);
      face.push_back(entry->second);
      middle += points[static_cast<std::size_t>(point)] / static_cast<double>(around.size());
    }
    const Vec3 x = n.unitOrthogonal(), y = n.cross(x);
    const auto angle = [&](int corner) {
      const Vec3 out = corners[static_cast<std::size_t>(corner)] - middle;
      return std::atan2(y.dot(out), x.dot(out));
    };
    std::sort(face.begin(), face.end(), [&](int a, int b) { return angle(a) < angle(b); });
  });
  return make_polyhedron(std::move(corners), std::move(faces));
}

}  // namespace

Polyhedron hull(const std::vector<Vec3>& points) {
  if (!std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); }))
    throw std::invalid_argument("contact::hull: the points must be finite");
  std::optional<Polyhedron> made;
  try {
    made = hull_with(points, "qhull");
  } catch (const std::invalid_argument&) {
    made = hull_with(points, "qhull Qt");  // faces that are merged may not close; triangles do
  }
  if (!made) throw std::invalid_argument("contact::hull: the points lie in one plane, or are fewer than four");
  return *std::move(made);
}

}  // namespace sinew::contact
