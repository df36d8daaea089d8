// Solids and rods of a snapshot as shaded triangles whose colours mean a value.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sinew/io/picture.hpp"
#include "sinew/io/picture_raster.hpp"
#include "sinew/sim/snapshot.hpp"

namespace sinew::io {

inline constexpr double kThinnestRod = 1.25;  ///< [px] least radius a rod is drawn with

/// Whether there is such a column and it can be drawn.
bool drawable(const Eigen::Matrix3Xd& points, int i);

/// Values [SI] per corner of a solid's surface triangles, in order; NaN where there is none.
std::vector<double> surface_values(const SolidSnapshot& solid, PictureColor color);

/// Values [SI] per sample of a rod; `before` is the same rod at rest, or null.
Eigen::VectorXd rod_values(const RodSnapshot& rod, const RodSnapshot* before, PictureColor color);

/// What the colours mean.
struct Scale {
  double largest = 0.0;  ///< SI
  bool open = false;     ///< there are larger ones
  double of(double value) const { return largest > 0.0 ? value / largest : 0.0 * value; }
};

/// Displacements up to their largest, or none if that is `roundoff` [m] of positions; stresses, which peak at corners,
/// up to what two in a hundred exceed.
Scale scale_of(std::vector<double> values, PictureColor color, double roundoff);

/// Adds a solid's surface with its nodes at `nodes`; without `values` in the first colour.
void add_surface(Raster& raster, const Eigen::Matrix3Xd& nodes, const SolidSnapshot& solid,
                 const std::vector<double>& values, const Scale& scale, const PictureView& view, double edge);

/// Adds a rigid body or an obstacle, in the colour of what has no value.
void add_body(Raster& raster, const BodySnapshot& body, const PictureView& view);

/// How dark mesh edges are: fading where they would be closer than a person can tell apart.
double edge_strength(const std::vector<SolidSnapshot>& solids, const PictureView& view);

/// Adds a rod as a round tube with flat ends.
void add_tube(Raster& raster, const RodSnapshot& rod, const Eigen::VectorXd& values, const Scale& scale,
              const PictureView& view);

}  // namespace sinew::io
