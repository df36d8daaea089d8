// Small meshes, written in every format that read_mesh reads.
#pragma once

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace sinew::io::samples {

struct Cell {
  int type;                 ///< VTK's number
  std::vector<int> nodes;   ///< in VTK's order
  std::vector<int> groups;  ///< numbers of Gmsh's physical groups; VTK files hold the first
};

struct Sample {
  std::vector<double> coordinates;
  std::vector<Cell> cells;
  std::vector<int> tags;                             ///< of the nodes in Gmsh
  std::map<std::pair<int, int>, std::string> names;  ///< of groups, by dimension and number
  std::string array = "SCALARS gmsh:physical int";   ///< that groups the cells in VTK: SCALARS or FIELD, name, type
  std::size_t points() const { return coordinates.size() / 3; }
  bool grouped() const {
    return std::any_of(cells.begin(), cells.end(), [](const Cell& cell) { return !cell.groups.empty(); });
  }
};

/// Two tetrahedra, a triangle and a vertex on five nodes, in no group.
inline const Sample two_tetrahedra = {
    {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1.25, 1},
    {{5, {0, 1, 2}, {}}, {10, {0, 1, 2, 3}, {}}, {1, {4}, {}}, {10, {1, 2, 3, 4}, {}}},
    {7, 3, 100, 5, 2},  // on purpose not 1 to 5
    {{{3, 1}, "all of it"}}};

/// What Gmsh calls a cell type of VTK.
struct GmshType {
  int type, dimension;
};
inline GmshType gmsh_type(int vtk_type) {
  static const std::map<int, GmshType> types = {{1, {15, 0}}, {3, {1, 1}},   {5, {2, 2}},  {9, {3, 2}},
                                                {10, {4, 3}}, {12, {5, 3}},  {13, {6, 3}}, {21, {8, 1}},
                                                {22, {9, 2}}, {24, {11, 3}}, {25, {17, 3}}};
  return types.at(vtk_type);
}

enum class Form { text, binary };

template <class T>
std::string bytes(T value, std::endian order) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return {raw.data(), raw.size()};
}

/// Numbers of type T, as words or as bytes.
template <class T, class Numbers>
std::string numbers(const Numbers& values, Form form, std::endian order) {
  std::string text;
  for (const auto value : values) {
    text += form == Form::text ? fmt::format("{} ", static_cast<T>(value)) : bytes(static_cast<T>(value), order);
  }
  return text + (form == Form::text ? "\n" : "");
}

inline std::vector<int> connectivity(const Sample& sample) {
  std::vector<int> all;
  for (const Cell& cell : sample.cells) all.insert(all.end(), cell.nodes.begin(), cell.nodes.end());
  return all;
}

inline std::vector<int> ends(const Sample& sample) {
  std::vector<int> all;
  for (const Cell& cell : sample.cells) {
    all.push_back((all.empty() ? 0 : all.back()) + static_cast<int>(cell.nodes.size()));
  }
  return all;
}

inline std::vector<int> types(const Sample& sample) {
  std::vector<int> all;
  for (const Cell& cell : sample.cells) all.push_back(cell.type);
  return all;
}

inline std::vector<int> groups(const Sample& sample) {
  std::vector<int> all;
  for (const Cell& cell : sample.cells) all.push_back(cell.groups.empty() ? 0 : cell.groups[0]);
  return all;
}

/// Numbers in a type that a legacy file names.
inline std::string typed(const std::string& type, const std::vector<int>& values, Form form, std::endian order) {
  if (type == "double") return numbers<double>(values, form, order);
  if (type == "short") return numbers<std::int16_t>(values, form, order);
  if (type == "vtktypeint64") return numbers<std::int64_t>(values, form, order);
  return numbers<std::int32_t>(values, form, order);
}

/// "SCALARS name type" or "FIELD name type" over the cells.
inline std::string legacy_array(const std::string& array, const std::vector<int>& values, Form form) {
  const std::size_t first = array.find(' '), last = array.rfind(' ');
  const std::string name = array.substr(first + 1, last - first - 1), type = array.substr(last + 1);
  const std::string head = array.starts_with("SCALARS")
                               ? fmt::format("{}\nLOOKUP_TABLE default\n", array)
                               : fmt::format("FIELD FieldData 1\n{} 1 {} {}\n", name, values.size(), type);
  return head + typed(type, values, form, std::endian::big) + "\n";
}

/// Version 2.0 or 5.1. A FIELD and METADATA are there because VTK's own writer puts them there.
inline std::string legacy_vtk(Form form, bool five, const Sample& sample = two_tetrahedra) {
  constexpr auto order = std::endian::big;
  const std::size_t points = sample.points(), cells = sample.cells.size(), entries = connectivity(sample).size();
  std::string text = fmt::format("# vtk DataFile Version {}\na title\n{}\nDATASET UNSTRUCTURED_GRID\n",
                                 five ? "5.1" : "2.0", form == Form::text ? "ASCII" : "BINARY");
  text += "FIELD FieldData 1\nTIME 1 1 double\n" + numbers<double>(std::vector{0.5}, form, order) + "\n";
  text += fmt::format("POINTS {} double\n", points) + numbers<double>(sample.coordinates, form, order);
  if (five) {
    text += "\nMETADATA\nINFORMATION 0\n\n";
    std::vector<int> offsets = ends(sample);
    offsets.insert(offsets.begin(), 0);
    text += fmt::format("CELLS {} {}\nOFFSETS vtktypeint64\n", cells + 1, entries);
    text += numbers<std::int64_t>(offsets, form, order);
    text += "\nCONNECTIVITY vtktypeint64\n" + numbers<std::int64_t>(connectivity(sample), form, order);
  } else {
    text += fmt::format("\nCELLS {} {}\n", cells, cells + entries);
    for (const Cell& cell : sample.cells) {
      text += numbers<std::int32_t>(std::vector{static_cast<int>(cell.nodes.size())}, form, order);
      text += numbers<std::int32_t>(cell.nodes, form, order);
    }
  }
  text += fmt::format("\nCELL_TYPES {}\n", cells) + numbers<std::int32_t>(types(sample), form, order);
  text += fmt::format("\nPOINT_DATA {}\nSCALARS s double\nLOOKUP_TABLE default\n", points);
  text += numbers<double>(std::vector<double>(points, 1.5), form, order) + "\n";
  if (!sample.grouped()) return text;
  return text + fmt::format("CELL_DATA {}\n", cells) + legacy_array(sample.array, groups(sample), form);
}

inline std::string base64(const std::string& plain) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < plain.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < plain.size() ? static_cast<unsigned char>(plain[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) text += i + k > plain.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

inline std::string deflated(const std::string& plain) {
  uLongf size = compressBound(plain.size());
  std::string packed(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(plain.data()),
               plain.size()) != Z_OK) {
    throw std::runtime_error("zlib");
  }
  packed.resize(size);
  return packed;
}

struct VtuForm {
  std::string format = "ascii";  ///< or "binary", "appended"
  std::string encoding = "raw";  ///< or "base64", if appended
  bool compressed = false;       ///< in blocks of 40 bytes
  bool wide = false;             ///< UInt64 headers
  std::endian order = std::endian::little;
};

inline std::string header(const std::vector<std::size_t>& words, const VtuForm& form) {
  return form.wide ? numbers<std::uint64_t>(words, Form::binary, form.order)
                   : numbers<std::uint32_t>(words, Form::binary, form.order);
}

/// An array as it stands in the file behind a header.
inline std::string packed(const std::string& plain, const VtuForm& form) {
  const bool text = form.format == "binary" || form.encoding == "base64";
  const auto coded = [text](const std::string& part) { return text ? base64(part) : part; };
  if (!form.compressed) return coded(header({plain.size()}, form) + plain);
  constexpr std::size_t block = 40;
  std::vector<std::size_t> words = {(plain.size() + block - 1) / block, block, plain.size() % block};
  std::string data;
  for (std::size_t i = 0; i < plain.size(); i += block) {
    const std::string part = deflated(plain.substr(i, block));
    words.push_back(part.size());
    data += part;
  }
  return coded(header(words, form)) + coded(data);
}

inline std::string vtu(const VtuForm& form, const Sample& sample = two_tetrahedra) {
  std::string appended;
  const auto array = [&]<class T>(T, const char* type, const char* attributes, const auto& values) {
    const std::string start = fmt::format("<DataArray type=\"{}\" {} format=\"{}\"", type, attributes, form.format);
    if (form.format == "ascii") return start + ">\n" + numbers<T>(values, Form::text, form.order) + "</DataArray>\n";
    const std::string data = packed(numbers<T>(values, Form::binary, form.order), form);
    if (form.format == "binary") return start + ">\n  " + data + "\n</DataArray>\n";
    const std::string element = start + fmt::format(" offset=\"{}\"/>\n", appended.size());
    appended += data;
    return element;
  };
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"{}\"{}>\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
      form.order == std::endian::big ? "BigEndian" : "LittleEndian", form.wide ? "UInt64" : "UInt32",
      form.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "", sample.points(), sample.cells.size());
  text += array(double{}, "Float64", "Name=\"Points\" NumberOfComponents=\"3\"", sample.coordinates);
  text += "</Points>\n<Cells>\n";
  text += array(std::int64_t{}, "Int64", "Name=\"connectivity\"", connectivity(sample));
  text += array(std::int32_t{}, "Int32", "Name=\"offsets\"", ends(sample));
  text += array(std::uint32_t{}, "UInt32", "Name=\"types\"", types(sample)) + "</Cells>\n";
  if (sample.grouped()) {
    const std::size_t name = sample.array.find(' ') + 1;
    const std::string attributes =
        fmt::format("Name=\"{}\"", sample.array.substr(name, sample.array.rfind(' ') - name));
    text += "<CellData>\n" + array(std::int32_t{}, "Int32", attributes.c_str(), groups(sample)) + "</CellData>\n";
  }
  text += "</Piece>\n</UnstructuredGrid>\n";
  if (form.format == "appended") {
    text += fmt::format("<AppendedData encoding=\"{}\">\n  _{}\n</AppendedData>\n", form.encoding, appended);
  }
  return text + "</VTKFile>\n";
}

/// Node tags in Gmsh's order: the last two of ten nodes stand the other way round.
inline std::vector<int> gmsh_nodes(const Cell& cell, const Sample& sample) {
  std::vector<int> result;
  for (const int node : cell.nodes) result.push_back(sample.tags[static_cast<std::size_t>(node)]);
  if (cell.type == 24) std::swap(result[8], result[9]);
  return result;
}

inline std::string gmsh_start(const char* version, Form form, std::endian order, const Sample& sample) {
  const bool text = form == Form::text;
  std::string start = fmt::format("$MeshFormat\n{} {} 8\n{}$EndMeshFormat\n", version, text ? 0 : 1,
                                  text ? "" : bytes(std::int32_t{1}, order) + "\n");
  start += fmt::format("$PhysicalNames\n{}\n", sample.names.size());
  for (const auto& [key, name] : sample.names) start += fmt::format("{} {} \"{}\"\n", key.first, key.second, name);
  return start + "$EndPhysicalNames\n";
}

/// An element in several groups stands there once for each.
inline std::string gmsh_2(Form form, std::endian order = std::endian::little, const Sample& sample = two_tetrahedra) {
  std::string text = gmsh_start("2.2", form, order, sample) + fmt::format("$Nodes\n{}\n", sample.points());
  for (std::size_t i = 0; i < sample.points(); ++i) {
    const double* place = &sample.coordinates[3 * i];
    text += numbers<std::int32_t>(std::vector{sample.tags[i]}, form, order);
    text += numbers<double>(std::vector(place, place + 3), form, order);
  }
  std::string elements;
  int count = 0;
  for (const Cell& cell : sample.cells) {
    const int type = gmsh_type(cell.type).type;
    for (const int group : cell.groups.empty() ? std::vector{0} : cell.groups) {
      ++count;
      const std::vector<int> head =
          form == Form::text ? std::vector{count, type, 2, group, 1} : std::vector{type, 1, 2, count, group, 1};
      elements += numbers<std::int32_t>(head, form, order);
      elements += numbers<std::int32_t>(gmsh_nodes(cell, sample), form, order);
    }
  }
  return text + fmt::format("\n$EndNodes\n$Elements\n{}\n", count) + elements + "\n$EndElements\n";
}

/// Two blocks of nodes, the second one with parameters (of a surface). An entity for every set of groups.
inline std::string gmsh_4(Form form, std::endian order = std::endian::little, const Sample& sample = two_tetrahedra) {
  const auto ints = [&](const std::vector<int>& values) { return numbers<std::int32_t>(values, form, order); };
  const auto sizes = [&](const std::vector<int>& values) { return numbers<std::uint64_t>(values, form, order); };
  const auto reals = [&](const std::vector<double>& values) { return numbers<double>(values, form, order); };
  const auto count = [](const auto& values) { return static_cast<int>(values.size()); };
  std::string text = gmsh_start("4.1", form, order, sample);
  std::array<std::vector<std::vector<int>>, 4> entities;  // per dimension, the groups of each
  const auto entity = [&entities](const Cell& cell) {
    auto& known = entities[static_cast<std::size_t>(gmsh_type(cell.type).dimension)];
    const auto found = std::find(known.begin(), known.end(), cell.groups);
    if (found != known.end()) return static_cast<int>(found - known.begin()) + 1;
    known.push_back(cell.groups);
    return static_cast<int>(known.size());
  };
  for (const Cell& cell : sample.cells) entity(cell);
  if (sample.grouped()) {
    text += "$Entities\n" + sizes({count(entities[0]), count(entities[1]), count(entities[2]), count(entities[3])});
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
      for (std::size_t i = 0; i < entities[dimension].size(); ++i) {
        const std::vector<int>& in = entities[dimension][i];
        text += ints({static_cast<int>(i) + 1}) + reals(std::vector<double>(dimension == 0 ? 3 : 6, 0.25));
        text += sizes({count(in)}) + ints(in);
        if (dimension > 0) text += sizes({2}) + ints({1, -1});
      }
    }
    text += "\n$EndEntities\n";
  }
  const int points = static_cast<int>(sample.points());
  const int largest = *std::max_element(sample.tags.begin(), sample.tags.end());
  text += "$Nodes\n" + sizes({2, points, 2, largest});
  text += ints({3, 1, 0}) + sizes({points - 1}) + sizes({sample.tags.begin(), sample.tags.end() - 1});
  text += reals({sample.coordinates.begin(), sample.coordinates.end() - 3});
  text += ints({2, 1, 1}) + sizes({1}) + sizes({sample.tags.back()});
  text += reals({sample.coordinates.end() - 3, sample.coordinates.end()}) + reals({0.5, 0.5});
  text += "\n$EndNodes\n$Elements\n" + sizes({count(sample.cells), count(sample.cells), 1, count(sample.cells)});
  for (std::size_t i = 0; i < sample.cells.size(); ++i) {
    const Cell& cell = sample.cells[i];
    const GmshType type = gmsh_type(cell.type);
    text += ints({type.dimension, entity(cell), type.type}) + sizes({1}) + sizes({static_cast<int>(i) + 1});
    text += sizes(gmsh_nodes(cell, sample));
  }
  return text + "\n$EndElements\n";
}

struct File {
  std::string name;
  std::string bytes;
};

/// Every format in every form.
inline std::vector<File> all_files(const Sample& sample = two_tetrahedra) {
  std::vector<File> files;
  for (const bool text : {true, false}) {
    const Form form = text ? Form::text : Form::binary;
    const std::string kind = text ? "_text" : "_binary";
    files.push_back({"vtk2" + kind + ".vtk", legacy_vtk(form, false, sample)});
    files.push_back({"vtk5" + kind + ".vtk", legacy_vtk(form, true, sample)});
    files.push_back({"gmsh2" + kind + ".msh", gmsh_2(form, std::endian::little, sample)});
    files.push_back({"gmsh4" + kind + ".msh", gmsh_4(form, std::endian::little, sample)});
  }
  files.push_back({"gmsh2_big.msh", gmsh_2(Form::binary, std::endian::big, sample)});
  files.push_back({"gmsh4_big.msh", gmsh_4(Form::binary, std::endian::big, sample)});
  files.push_back({"ascii.vtu", vtu({}, sample)});
  for (const char* format : {"binary", "appended"}) {
    for (const char* encoding : {"raw", "base64"}) {
      for (int i = 0; i < 8; ++i) {
        const VtuForm form = {.format = format,
                              .encoding = encoding,
                              .compressed = (i & 1) != 0,
                              .wide = (i & 2) != 0,
                              .order = (i & 4) != 0 ? std::endian::big : std::endian::little};
        files.push_back({fmt::format("{}_{}_{}.vtu", format, encoding, i), vtu(form, sample)});
      }
    }
  }
  return files;
}

}  // namespace sinew::io::samples
