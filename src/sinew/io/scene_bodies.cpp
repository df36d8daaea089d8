// Rigid bodies, obstacles, and the rules of contact.
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_regions.hpp"

namespace sinew::io {
namespace {

using enum Need;

Type<double> length() { return quantity(Dimension::length, above(0.0)); }

Type<BoxShape> box() {
  const auto check = [](const BoxShape& box, const At& at) {
    for (int i = 0; i < 3; ++i) {
      if (!(box.size[i] > 0.0)) at.child("size").item(static_cast<std::size_t>(i)).refuse("must be greater than 0");
    }
  };
  return map<BoxShape>({"a box",
                        {field<BoxShape>({"size", required, "its edges along x, y and z [m]", "[20 mm, 20 mm, 20 mm]"},
                                         &BoxShape::size, vec3(Dimension::length))},
                        {},
                        check});
}

Type<SphereShape> sphere() {
  return map<SphereShape>(
      {"a sphere",
       {field<SphereShape>({"radius", required, "its radius [m]", "10 mm"}, &SphereShape::radius, length())}});
}

Type<CylinderShape> cylinder() {
  using C = CylinderShape;
  return map<C>({"a cylinder about z",
                 {field<C>({"radius", required, "its radius [m]", "10 mm"}, &C::radius, length()),
                  field<C>({"length", required, "its length [m]", "50 mm"}, &C::length, length())}});
}

Type<CapsuleShape> capsule() {
  using C = CapsuleShape;
  return map<C>(
      {"a capsule along z",
       {field<C>({"radius", required, "its radius [m]", "5 mm"}, &C::radius, length()),
        field<C>({"length", required, "its length without the round ends [m]", "30 mm"}, &C::length, length())}});
}

Type<MeshShape> mesh() {
  using M = MeshShape;
  return map<M>(
      {"a surface from a file, closed or with a thickness",
       {field<M>({"file", required, "its triangles (.stl, .obj, or a volume mesh), looked up from the scene's folder",
                  "part.stl"},
                 &M::file, file_name()),
        field<M>({"scale", optional, "what its coordinates are multiplied by to be in m", "0.001"}, &M::scale,
                 quantity(Dimension::number, above(0.0))),
        field<M>({"hull", optional, "the smallest convex body around it instead", "true"}, &M::hull, boolean()),
        field<M>(
            {"thickness", optional,
             "of a sheet with the surface in its middle, met from both sides; the surface may be open [m]", "1 mm"},
            &M::thickness, length())}});
}

Type<PlaneShape> plane() {
  using P = PlaneShape;
  return map<P>(
      {"the surface of a half-space",
       {field<P>({"point", optional, "a point of it [m]", "[0, 0, -160 mm]"}, &P::point, vec3(Dimension::length)),
        field<P>({"normal", required, "the direction out of the ground", "[0, 0, 1]"}, &P::normal, direction())}});
}

/// The key that names the shape, among the others of its object.
template <class T, class Shape>
std::vector<Field<T>> shape_fields(Shape T::*where) {
  const auto one = [where](std::string name, std::string doc, std::string example, auto type) {
    return Field<T>{{std::move(name), optional, std::move(doc), std::move(example)},
                    [=](T& object, const At& at) { object.*where = type.read(at); },
                    type.schema};
  };
  return {one("box", "a box around the origin of its axes", "{size: [20 mm, 20 mm, 20 mm]}", box()),
          one("sphere", "a sphere around the origin", "{radius: 10 mm}", sphere()),
          one("cylinder", "a cylinder about z", "{radius: 10 mm, length: 50 mm}", cylinder()),
          one("capsule", "all within a radius of a segment along z", "{radius: 5 mm, length: 30 mm}", capsule()),
          one("mesh", "a surface of triangles, closed or with a thickness, in the axes of its file", "{file: part.stl}",
              mesh())};
}

Range part() { return {.lower = 0.0, .upper = 1.0}; }

Type<std::vector<std::string>> two_names() { return list<std::string>("two names", text(), {2, 2}); }

Type<ContactPair> pair() {
  using P = ContactPair;
  const Type<std::vector<std::string>> names = two_names();
  return map<P>({"a pair of objects",
                 {{{"between", required, "the names of the two; a solid named twice meets itself", "[cube, floor]"},
                   [=](P& own, const At& at) {
                     const std::vector<std::string> both = names.read(at);
                     own.first = both[0];
                     own.second = both[1];
                   },
                   names.schema},
                  field<P>({"friction", optional, "Coulomb's coefficient between them", "0.5"}, &P::friction,
                           quantity(Dimension::number, at_least(0.0))),
                  field<P>({"restitution", optional, "how much of its speed a hit gives back", "0.3"}, &P::restitution,
                           quantity(Dimension::number, part())),
                  field<P>({"off", optional, "they pass through each other", "true"}, &P::off, boolean())}});
}

}  // namespace

Type<RigidBody> rigid_body() {
  using B = RigidBody;
  return map<B>(
      {"a rigid body",
       together<B>(shape_fields<B>(&B::shape),
                   {field<B>({"pose", optional, "where its axes are at the start: at its middle, or those of its mesh",
                              "{translate: [0, 0, 10 mm]}"},
                             &B::pose, pose()),
                    field<B>({"mass", optional, "its mass [kg], instead of density", "30 g"}, &B::mass,
                             quantity(Dimension::mass, above(0.0))),
                    field<B>({"density", optional, "its density [kg/m^3], instead of mass", "1200 kg/m^3"}, &B::density,
                             quantity(Dimension::density, above(0.0))),
                    field<B>({"velocity", optional, "at the start [m/s]", "[0, 0, -1 m/s]"}, &B::velocity,
                             vec3(Dimension::velocity)),
                    field<B>({"spin", optional, "its angular velocity at the start, about the world's axes [rad/s]",
                              "[0, 0, 10 rad/s]"},
                             &B::spin, vec3(Dimension::turning))}),
       {exactly_one({"box", "sphere", "cylinder", "capsule", "mesh"}), exactly_one({"mass", "density"})}});
}

Type<Obstacle> obstacle() {
  using O = Obstacle;
  const Type<PlaneShape> flat = plane();
  return map<O>(
      {"an obstacle",
       together<O>(shape_fields<O>(&O::shape),
                   {{{"plane", optional, "a half-space; given by its surface", "{point: [0, 0, 0], normal: [0, 0, 1]}"},
                     [=](O& own, const At& at) { own.shape = flat.read(at); },
                     flat.schema},
                    field<O>({"pose", optional, "where it stands", "{translate: [0, 0, 10 mm]}"}, &O::pose, pose()),
                    field<O>({"frame", optional, "the frame that carries it", "hand"}, &O::frame, name_of("frame"))}),
       {exactly_one({"box", "sphere", "cylinder", "capsule", "mesh", "plane"})}});
}

Type<Contact> contact() {
  using C = Contact;
  return map<C>({"contact",
                 {field<C>({"friction", optional, "Coulomb's coefficient of all pairs", "0.5"}, &C::friction,
                           quantity(Dimension::number, at_least(0.0))),
                  field<C>({"restitution", optional, "how much of its speed any hit gives back", "0.3"},
                           &C::restitution, quantity(Dimension::number, part())),
                  field<C>({"pairs", optional, "pairs of objects with rules of their own",
                            "[{between: [cube, floor], friction: 0.08}]"},
                           &C::pairs, list<ContactPair>("pairs", pair(), {1}))}});
}

}  // namespace sinew::io
