// Cross-sections and materials of rods.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A length of a cross-section, positive, that may change along the part.
Type<Taper> size() { return taper(Dimension::length, above(0.0)); }

Type<Circle> circle() {
  return map<Circle>({"a circle",
                      {field<Circle>({"radius", required, "its radius [m], or a pair [start, end]", "0.5 mm"},
                                     &Circle::radius, size())}});
}

Type<Tube> tube() {
  const auto check = [](const Tube& tube, const At& at) {
    for (const auto& [inner, outer, where] :
         {std::tuple(tube.inner.start, tube.outer.start, "start"), std::tuple(tube.inner.end, tube.outer.end, "end")}) {
      if (inner < outer) continue;
      at.child("inner").refuse(
          fmt::format("must be smaller than `outer`, but at the {} it is {} m and outer {} m", where, inner, outer),
          "give the two radii of the wall, or `circle` for a full section");
    }
  };
  return map<Tube>(
      {"a tube",
       {field<Tube>({"outer", required, "its outer radius [m], or a pair [start, end]", "5 mm"}, &Tube::outer, size()),
        field<Tube>({"inner", required, "its inner radius [m], or a pair [start, end]", "4 mm"}, &Tube::inner, size())},
       {},
       check});
}

Type<Ellipse> ellipse() {
  using E = Ellipse;
  return map<E>(
      {"an ellipse",
       {field<E>({"y", required, "its half axis along y [m], or a pair [start, end]", "2 mm"}, &E::y, size()),
        field<E>({"z", required, "its half axis along z [m], or a pair [start, end]", "1 mm"}, &E::z, size())}});
}

Type<Rectangle> rectangle() {
  using R = Rectangle;
  return map<R>({"a rectangle",
                 {field<R>({"y", required, "its side along y [m], or a pair [start, end]", "4 mm"}, &R::y, size()),
                  field<R>({"z", required, "its side along z [m], or a pair [start, end]", "2 mm"}, &R::z, size())}});
}

/// Symmetric and positive definite, whatever the units of its entries.
void check_stiffness(const Matrix6& matrix, const At& at) {
  for (int i = 0; i < 6; ++i) {
    if (!(matrix(i, i) > 0.0)) at.item(i).item(i).refuse("must be greater than 0: it is on the diagonal");
  }
  const Eigen::Array<double, 6, 1> scale = matrix.diagonal().array().sqrt();
  Matrix6 scaled;  // with a diagonal of ones
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) scaled(i, j) = matrix(i, j) / scale[i] / scale[j];
  }
  constexpr double rounding = 1e-9;  // of numbers that another program has written
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      if (std::abs(scaled(i, j) - scaled(j, i)) <= rounding) continue;
      at.item(i).item(j).refuse(
          fmt::format("must be the same as entry {} of row {}, {}: the matrix is symmetric", i, j, matrix(j, i)),
          "give both the same value");
    }
  }
  if (!scaled.allFinite() || Eigen::SelfAdjointEigenSolver<Matrix6>(scaled).eigenvalues()[0] <= rounding) {
    at.refuse("must be positive definite: every strain costs energy",
              "make the entries beside the diagonal smaller, or check their signs and their order");
  }
}

/// The six numbers of a diagonal, or six rows of six.
Type<Matrix6> stiffness_matrix() {
  const Type<std::vector<double>> diagonal =
      list<double>("numbers, the diagonal", quantity(Dimension::number, above(0.0)), {6, 6});
  const Type<std::vector<std::vector<double>>> rows =
      list<std::vector<double>>("rows", list<double>("numbers, a row", quantity(Dimension::number), {6, 6}), {6, 6});
  const auto read = [=](const At& at) {
    Matrix6 matrix = Matrix6::Zero();
    if (!at.is(Node::Kind::list)) at.refuse("must be a list of 6 numbers, the diagonal, or of 6 rows of 6 numbers");
    if (at.node().items.empty() || at.node().items[0].kind != Node::Kind::list) {
      const std::vector<double> values = diagonal.read(at);
      for (int i = 0; i < 6; ++i) matrix(i, i) = values[i];
      return matrix;
    }
    const std::vector<std::vector<double>> values = rows.read(at);
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) matrix(i, j) = values[i][j];
    }
    check_stiffness(matrix, at);
    return Matrix6(0.5 * (matrix + matrix.transpose()));
  };
  return {read, [=] { return any_of({diagonal.schema(), rows.schema()}); }};
}

Type<GivenSection> given_section() {
  using G = GivenSection;
  return map<G>(
      {"a given stiffness",
       {field<G>({"matrix", required,
                  "the stiffness [N m^2, N m, N] against torsion, bending_y, bending_z, elongation, shear_y, shear_z: "
                  "its diagonal or its six rows",
                  "[4e-4, 5e-4, 5e-4, 4e3, 1e3, 1e3]"},
                 &G::stiffness, stiffness_matrix()),
        field<G>({"line_density", required, "its mass per length [kg/m], 0 for a massless rod", "1 g/m"},
                 &G::line_density, quantity(Dimension::line_density, at_least(0.0))),
        field<G>({"radius", required, "the radius with which it is drawn and turns [m]", "5 mm"}, &G::radius,
                 quantity(Dimension::length, above(0.0)))}});
}

}  // namespace

Type<CrossSection> cross_section() {
  return one_of_kinds<CrossSection>(
      "a section", {kind<CrossSection>("circle", "a full circle", "{radius: 0.5 mm}", circle()),
                    kind<CrossSection>("tube", "a circle with a hole", "{outer: 5 mm, inner: 4 mm}", tube()),
                    kind<CrossSection>("ellipse", "a full ellipse", "{y: 2 mm, z: 1 mm}", ellipse()),
                    kind<CrossSection>("rectangle", "a full rectangle", "{y: 4 mm, z: 2 mm}", rectangle()),
                    kind<CrossSection>("stiffness", "a section whose stiffness is known",
                                       "{matrix: [4e-4, 5e-4, 5e-4, 4e3, 1e3, 1e3], line_density: 1 g/m, radius: 1 mm}",
                                       given_section())});
}

Type<RodMaterial> rod_material(Wants wants) {
  using M = RodMaterial;
  const Range poisson = {-1.0, 0.5, true, false, " in a rod", "use 0.5 for an incompressible rubber, 0.3 for steel"};
  const Need need = wants == Wants::modulus ? required : optional;
  const auto wanted = [need](Field<M> f) {
    f.key.need = need;
    return f;
  };
  return map<M>(
      {"a rod's material",
       {wanted(field<M>({"young", required, "Young's modulus [Pa]", "5 GPa"}, &M::young,
                        quantity(Dimension::pressure, above(0.0)))),
        wanted(field<M>({"poisson", required, "Poisson's ratio", "0.4"}, &M::poisson,
                        quantity(Dimension::number, poisson))),
        wanted(field<M>({"density", required, "its density [kg/m^3], 0 for a massless rod", "1100 kg/m^3"}, &M::density,
                        quantity(Dimension::density, at_least(0.0)))),
        field<M>({"viscosity", optional, "its viscosity against shear [Pa s]; three times as much against extension",
                  "300 Pa s"},
                 &M::viscosity, quantity(Dimension::viscosity, at_least(0.0))),
        field<M>({"damping", optional, "its damping over its stiffness [s], which adds to viscosity", "10 ms"},
                 &M::damping, quantity(Dimension::time, at_least(0.0)))}});
}

Rule material_for_section() {
  const std::vector<std::string> of_a_shape = {"young", "poisson", "density", "viscosity"};
  const auto check = [of_a_shape](const At& at, const std::vector<Key>& keys) {
    if (!at.has("section")) return;
    const At section = at.child("section");
    if (section.is(Node::Kind::map) && section.has("stiffness")) {
      for (const std::string& name : of_a_shape) {
        if (!at.has("material") || !at.child("material").has(name)) continue;
        at.child("material")
            .refuse_key(name, "has no meaning beside a given stiffness",
                        "remove it: `matrix` and `line_density` say all, only `damping` may be added");
      }
      return;
    }
    if (at.has("material") || at.says("cable", "geometric")) return;
    for (const Key& key : keys) {
      if (key.name == "material") at.refuse_key("material", "is missing", "add it: " + help(key));
    }
  };
  const Json needs_one = {{"required", {"section"}},
                          {"properties", {{"section", {{"not", {{"required", {"stiffness"}}}}}}}},
                          {"not", says_schema("cable", "geometric")}};
  const Json full = {{"required", {"material"}},
                     {"properties", {{"material", {{"required", {"young", "poisson", "density"}}}}}}};
  const Json is_given = {{"required", {"section"}},
                         {"properties", {{"section", {{"type", "object"}, {"required", {"stiffness"}}}}}}};
  Json none_of_a_shape;
  for (const std::string& name : of_a_shape) none_of_a_shape[name] = false;
  const Json damping_only = {{"properties", {{"material", {{"properties", none_of_a_shape}}}}}};
  Json schema;
  schema["allOf"].push_back({{"if", needs_one}, {"then", full}});
  schema["allOf"].push_back({{"if", is_given}, {"then", damping_only}});
  return {check, schema};
}

}  // namespace sinew::io
