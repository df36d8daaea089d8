// Regions of solids: keys that an object takes in to say which of its nodes, cells or faces it means.
#pragma once

#include "sinew/io/scene_values.hpp"

namespace sinew::io {

/// A key that gives a region: box, sphere, plane, nodes, group or surface.
struct RegionKey {
  Key key;
  Type<Region> type;
};
const std::vector<RegionKey>& region_keys();
std::vector<std::string> region_names();

/// Says where a region's coordinates are given; of those that have none, refused at `at`.
void set_in(Region& region, In in, const At& at);

/// The keys of a region and `in`. `access` names the Region, or optional Region, that they are stored in. Exactly one
/// of region_names() is for the object's rules to ask for.
template <class T, class Access>
std::vector<Field<T>> region_fields(Access access) {
  std::vector<Field<T>> fields;
  for (const RegionKey& own : region_keys())
    fields.push_back(
        {own.key, [=](T& object, const At& at) { std::invoke(access, object) = own.type.read(at); }, own.type.schema});
  const Type<In> where = in();
  fields.push_back(
      {{"in", Need::optional, "where the region is given, in the object before its pose or the world", "world"},
       [=](T& object, const At& at) {
         auto& target = std::invoke(access, object);
         if constexpr (std::is_same_v<std::remove_cvref_t<decltype(target)>, Region>) {
           set_in(target, where.read(at), at);
         } else if (target) {
           set_in(*target, where.read(at), at);
         }
       },
       where.schema});
  return fields;
}

/// Fields of two lists, one after the other.
template <class T>
std::vector<Field<T>> together(std::vector<Field<T>> first, const std::vector<Field<T>>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Some of the axes x, y, z.
Type<std::array<bool, 3>> axes(Count count);

}  // namespace sinew::io
