#include "sinew/io/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sinew/io/atomic_file.hpp"

namespace sinew::io {
namespace {

constexpr std::uint8_t kPolyline = 4;  // cell type of VTK
constexpr const char* kByteOrder = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
constexpr const char* kCollectionEnd = "  </Collection>\n</VTKFile>\n";

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

/// A DataArray: size in bytes as UInt64, then the values, together in base64.
template <class Value>
std::string array(const char* type, const std::string& attributes, const Value* values, std::size_t count) {
  const std::uint64_t bytes = count * sizeof(Value);
  std::string raw(sizeof bytes + bytes, '\0');
  std::memcpy(raw.data(), &bytes, sizeof bytes);
  if (bytes > 0) std::memcpy(raw.data() + sizeof bytes, values, bytes);
  return fmt::format("<DataArray type=\"{}\" {} format=\"binary\">{}</DataArray>\n", type, attributes, base64(raw));
}

std::string doubles(const std::string& name, const Eigen::MatrixXd& values) {  // one column a point
  return array("Float64", fmt::format("Name=\"{}\" NumberOfComponents=\"{}\"", name, values.rows()), values.data(),
               static_cast<std::size_t>(values.size()));
}

/// VTK's number of an element; the nodes stand in VTK's order already.
std::uint8_t cell_type(solid::Kind kind) {
  switch (kind) {
    case solid::Kind::tet4:
      return 10;
    case solid::Kind::tet10:
      return 24;
    case solid::Kind::hex8:
      break;
  }
  return 12;
}

/// Cells given as node lists of any length.
std::string cells(const std::vector<std::int64_t>& connectivity, const std::vector<std::int64_t>& ends,
                  const std::vector<std::uint8_t>& types) {
  return "<Cells>\n" + array("Int64", "Name=\"connectivity\"", connectivity.data(), connectivity.size()) +
         array("Int64", "Name=\"offsets\"", ends.data(), ends.size()) +
         array("UInt8", "Name=\"types\"", types.data(), types.size()) + "</Cells>\n";
}

std::string grid(double time, const Eigen::Matrix3Xd& points, std::size_t cell_count, const std::string& cells_text,
                 const std::string& point_data, const std::string& cell_data) {
  return fmt::format(
             "<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
             "<UnstructuredGrid>\n<FieldData>\n",
             kByteOrder) +
         array("Float64", "Name=\"TimeValue\" NumberOfTuples=\"1\"", &time, 1) +
         fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n", points.cols(),
                     cell_count) +
         doubles("Points", points) + "</Points>\n" + cells_text + "<PointData>\n" + point_data +
         "</PointData>\n<CellData>\n" + cell_data + "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

/// What every file system and every reader of .pvd takes.
std::string plain(const std::string& name) {
  std::string text = name.empty() ? "unnamed" : name;
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  return text;
}

}  // namespace

std::string vtu_text(const SolidSnapshot& solid, double time) {
  std::vector<std::int64_t> connectivity, ends;
  std::vector<std::uint8_t> types;
  for (const solid::Cell& cell : solid.cells) {
    connectivity.insert(connectivity.end(), cell.nodes().begin(), cell.nodes().end());
    ends.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(cell_type(cell.kind));
  }
  std::string point_data, cell_data;
  if (solid.rest.cols() == solid.nodes.cols()) point_data = doubles("displacement", solid.nodes - solid.rest);
  if (solid.von_mises.size() == static_cast<Eigen::Index>(solid.cells.size()))
    cell_data = doubles("von_mises", solid.von_mises.transpose());
  for (const Field& field : solid.fields) cell_data += doubles(field.name, field.values);
  return grid(time, solid.nodes, ends.size(), cells(connectivity, ends, types), point_data, cell_data);
}

std::string vtu_text(const RodSnapshot& rod, double time) {
  const Eigen::Index samples = rod.points.cols();
  std::vector<std::int64_t> connectivity, ends;
  for (Eigen::Index i = 0; i < samples; ++i) connectivity.push_back(i);
  if (samples > 0) ends.push_back(samples);
  const std::vector<std::uint8_t> types(ends.size(), kPolyline);

  std::string data;
  const auto add = [&](const std::string& name, const Eigen::MatrixXd& values) {
    if (values.cols() == samples) data += doubles(name, values);
  };
  add("abscissa", rod.abscissa.transpose());
  add("radius", rod.radius.transpose());
  add("tangent", rod.tangents);
  for (const Field& field : rod.fields) add(field.name, field.values);
  add("von_mises", rod.von_mises.transpose());
  return grid(time, rod.points, ends.size(), cells(connectivity, ends, types), data, "");
}

std::string vtu_text(const BodySnapshot& body, double time) {
  constexpr std::uint8_t kTriangle = 5;  // cell type of VTK
  std::vector<std::int64_t> connectivity, ends;
  for (const solid::Triangle& triangle : body.surface) {
    connectivity.insert(connectivity.end(), triangle.begin(), triangle.end());
    ends.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(ends.size(), kTriangle);
  return grid(time, body.points, ends.size(), cells(connectivity, ends, types), "", "");
}

std::string vtu_text(const std::vector<ForceSnapshot>& contacts, double time) {
  constexpr std::uint8_t kVertex = 1;  // cell type of VTK
  const auto count = static_cast<Eigen::Index>(contacts.size());
  Eigen::Matrix3Xd points(3, count), force(3, count), normal(3, count);
  std::vector<std::int64_t> connectivity, ends;
  for (Eigen::Index i = 0; i < count; ++i) {
    points.col(i) = contacts[static_cast<std::size_t>(i)].position;
    force.col(i) = contacts[static_cast<std::size_t>(i)].force;
    normal.col(i) = contacts[static_cast<std::size_t>(i)].normal;
    connectivity.push_back(i);
    ends.push_back(i + 1);
  }
  const std::vector<std::uint8_t> types(ends.size(), kVertex);
  return grid(time, points, ends.size(), cells(connectivity, ends, types),
              doubles("force", force) + doubles("normal", normal), "");
}

SeriesWriter::SeriesWriter(std::filesystem::path folder)
    : final_(std::move(folder)), folder_(partial_path(final_)), taken_{"run"} {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);  // (of a program that was killed)
  create_folder(folder_);
  collection("run");
}

SeriesWriter::~SeriesWriter() {
  if (finished_) return;
  collections_.clear();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void SeriesWriter::add(const Snapshot& snapshot) {
  if (finished_) throw std::logic_error("a finished series takes no more snapshots");
  for (const SolidSnapshot& solid : snapshot.solids)
    add_part(part_of(solid.name, "solid"), vtu_text(solid, snapshot.time), snapshot.time);
  for (const RodSnapshot& rod : snapshot.rods)
    add_part(part_of(rod.name, "rod"), vtu_text(rod, snapshot.time), snapshot.time);
  for (const BodySnapshot& body : snapshot.bodies)
    add_part(part_of(body.name, "body"), vtu_text(body, snapshot.time), snapshot.time);
  if (!snapshot.bodies.empty())
    add_part(part_of("contacts", "contacts"), vtu_text(snapshot.contacts, snapshot.time), snapshot.time);
}

void SeriesWriter::finish() {
  if (finished_) return;
  collections_.clear();
  remove_earlier(final_);
  rename_to(folder_, final_);
  finished_ = true;
}

SeriesWriter::Part& SeriesWriter::part_of(const std::string& name, const std::string& kind) {
  const auto found = parts_.find({kind, name});
  if (found != parts_.end()) return found->second;
  std::string file_name = plain(name);
  while (!taken_.insert(file_name).second) file_name += "_" + kind;
  const int number = static_cast<int>(parts_.size());
  return parts_.insert({{kind, name}, {file_name, name, number, 0}}).first->second;
}

SeriesWriter::Collection& SeriesWriter::collection(const std::string& file_name) {
  const auto found = collections_.find(file_name);
  if (found != collections_.end()) return found->second;
  const std::string start = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"{}\">\n  <Collection>\n",
      kByteOrder);
  Collection made{AppendFile(folder_ / (file_name + ".pvd"), AppendFile::Start::empty), start.size()};
  made.file.append(start + kCollectionEnd);
  return collections_.emplace(file_name, std::move(made)).first->second;
}

void SeriesWriter::add_part(Part& part, const std::string& text, double time) {
  const std::string file = fmt::format("{}_{:04}.vtu", part.file_name, part.frames++);
  AppendFile(folder_ / file, AppendFile::Start::empty).append(text);
  add_entry(collection(part.file_name), part, file, time);
  add_entry(collection("run"), part, file, time);
}

void SeriesWriter::add_entry(Collection& collection, const Part& part, const std::string& file, double time) {
  const bool all = collection.file.path().stem() == "run";
  const std::string entry =
      fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", time,
                  all ? part.number : 0, escaped(part.name), file);
  collection.file.write_at(collection.end, entry + kCollectionEnd);
  collection.end += entry.size();
}

}  // namespace sinew::io
