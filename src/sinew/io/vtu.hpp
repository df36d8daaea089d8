// ParaView files of a run: open `run.pvd` and everything is there, part by part, over time.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "sinew/io/append_file.hpp"
#include "sinew/sim/snapshot.hpp"

namespace sinew::io {

/// Text of an unstructured grid (.vtu) of a solid: its cells at their present place; point data `displacement` [m];
/// cell data `von_mises` [Pa] and the snapshot's fields (`stress` [Pa], `strain`, `volume_ratio`, `least_volume_ratio`,
/// `material`). Every number is written with all its bits (base64).
std::string vtu_text(const SolidSnapshot& solid, double time);

/// The same of a rod: one polyline; point data `abscissa` [m], `radius` [m], `tangent`, the strains `torsion`,
/// `bending_y`, `bending_z` [1/m], `elongation`, `shear_y`, `shear_z` [-], their stresses `torsion_moment`,
/// `bending_moment_y`, `bending_moment_z` [N m], `axial_force`, `shear_force_y`, `shear_force_z` [N], `axial_stress`,
/// `bending_stress`, `torsion_stress` and `von_mises` [Pa]. What the snapshot does not have (strains of a geometric
/// cable) is left out.
std::string vtu_text(const RodSnapshot& rod, double time);

/// The same of a rigid body or an obstacle: its surface.
std::string vtu_text(const BodySnapshot& body, double time);

/// Points of contact; point data `force` [N], on what `normal` points to.
std::string vtu_text(const std::vector<ForceSnapshot>& contacts, double time);

/// Writes a series snapshot by snapshot. Of each solid and rod: <name>_0000.vtu, <name>_0001.vtu, ... and <name>.pvd;
/// `run.pvd` has them all as named parts. Where a name is taken (a rod of a solid's name, or "run"), `_rod` or `_solid`
/// is added to the file's. The folder is there once the series is finished, in place of any earlier one; until then its
/// files are in `<folder>.partial`. Throws WriteError.
class SeriesWriter {
 public:
  explicit SeriesWriter(std::filesystem::path folder);
  /// Removes what was not finished.
  ~SeriesWriter();
  SeriesWriter(const SeriesWriter&) = delete;
  SeriesWriter& operator=(const SeriesWriter&) = delete;

  void add(const Snapshot& snapshot);

  /// Closes the files; nothing can be added any more.
  void finish();

 private:
  /// A .pvd file and where its closing lines start.
  struct Collection {
    AppendFile file;
    std::uint64_t end = 0;
  };
  struct Part {
    std::string file_name;  ///< without number and extension
    std::string name;       ///< as the snapshot has it
    int number = 0;         ///< in run.pvd
    int frames = 0;         ///< written so far
  };

  Part& part_of(const std::string& name, const std::string& kind);
  Collection& collection(const std::string& file_name);
  void add_part(Part& part, const std::string& text, double time);
  void add_entry(Collection& collection, const Part& part, const std::string& file, double time);

  std::filesystem::path final_, folder_;
  std::map<std::pair<std::string, std::string>, Part> parts_;  ///< by kind and name
  std::set<std::string> taken_;                                ///< file names of parts, and "run"
  std::map<std::string, Collection> collections_;
  bool finished_ = false;
};

}  // namespace sinew::io
