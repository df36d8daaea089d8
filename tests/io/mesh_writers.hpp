// One small mesh, written in every format that read_mesh reads: two tetrahedra, a triangle and a vertex on five nodes.
#pragma once

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace sinew::io::samples {

inline const std::vector<double> coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1.25, 1};
inline const std::vector<std::vector<int>> cells = {{0, 1, 2}, {0, 1, 2, 3}, {4}, {1, 2, 3, 4}};
inline const std::vector<int> vtk_types = {5, 10, 1, 10};
inline const std::vector<int> gmsh_types = {2, 4, 15, 4};
inline const std::vector<int> gmsh_tags = {7, 3, 100, 5, 2};  // of the nodes, on purpose not 1 to 5

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

inline std::vector<int> connectivity() {
  std::vector<int> all;
  for (const auto& cell : cells) all.insert(all.end(), cell.begin(), cell.end());
  return all;
}

inline std::vector<int> ends() {
  std::vector<int> all;
  for (const auto& cell : cells) all.push_back((all.empty() ? 0 : all.back()) + static_cast<int>(cell.size()));
  return all;
}

/// Version 2.0 or 5.1. A FIELD and METADATA are there because VTK's own writer puts them there.
inline std::string legacy_vtk(Form form, bool five) {
  constexpr auto order = std::endian::big;
  std::string text = fmt::format("# vtk DataFile Version {}\na title\n{}\nDATASET UNSTRUCTURED_GRID\n",
                                 five ? "5.1" : "2.0", form == Form::text ? "ASCII" : "BINARY");
  text += "FIELD FieldData 1\nTIME 1 1 double\n" + numbers<double>(std::vector{0.5}, form, order) + "\n";
  text += "POINTS 5 double\n" + numbers<double>(coordinates, form, order);
  if (five) {
    text += "\nMETADATA\nINFORMATION 0\n\n";
    std::vector<int> offsets = ends();
    offsets.insert(offsets.begin(), 0);
    text += "CELLS 5 12\nOFFSETS vtktypeint64\n" + numbers<std::int64_t>(offsets, form, order);
    text += "\nCONNECTIVITY vtktypeint64\n" + numbers<std::int64_t>(connectivity(), form, order);
  } else {
    text += "\nCELLS 4 16\n";
    for (const auto& cell : cells) {
      text += numbers<std::int32_t>(std::vector{static_cast<int>(cell.size())}, form, order);
      text += numbers<std::int32_t>(cell, form, order);
    }
  }
  text += "\nCELL_TYPES 4\n" + numbers<std::int32_t>(vtk_types, form, order);
  return text + "\nPOINT_DATA 5\nSCALARS s double\nLOOKUP_TABLE default\n1 2 3 4 5\n";
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

inline std::string vtu(const VtuForm& form) {
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
      "header_type=\"{}\"{}>\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"5\" NumberOfCells=\"4\">\n<Points>\n",
      form.order == std::endian::big ? "BigEndian" : "LittleEndian", form.wide ? "UInt64" : "UInt32",
      form.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "");
  text += array(double{}, "Float64", "Name=\"Points\" NumberOfComponents=\"3\"", coordinates) + "</Points>\n<Cells>\n";
  text += array(std::int64_t{}, "Int64", "Name=\"connectivity\"", connectivity());
  text += array(std::int32_t{}, "Int32", "Name=\"offsets\"", ends());
  text += array(std::uint32_t{}, "UInt32", "Name=\"types\"", vtk_types) + "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
  if (form.format == "appended") {
    text += fmt::format("<AppendedData encoding=\"{}\">\n  _{}\n</AppendedData>\n", form.encoding, appended);
  }
  return text + "</VTKFile>\n";
}

inline std::vector<int> tags(const std::vector<int>& nodes) {
  std::vector<int> result;
  for (const int node : nodes) result.push_back(gmsh_tags[static_cast<std::size_t>(node)]);
  return result;
}

inline std::string gmsh_start(const char* version, Form form, std::endian order) {
  const bool text = form == Form::text;
  return fmt::format(
      "$MeshFormat\n{} {} 8\n{}$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"all of it\"\n$EndPhysicalNames\n", version,
      text ? 0 : 1, text ? "" : bytes(std::int32_t{1}, order) + "\n");
}

inline std::string gmsh_2(Form form, std::endian order = std::endian::little) {
  std::string text = gmsh_start("2.2", form, order) + "$Nodes\n5\n";
  for (std::size_t i = 0; i < 5; ++i) {
    text += numbers<std::int32_t>(std::vector{gmsh_tags[i]}, form, order);
    text += numbers<double>(std::vector(&coordinates[3 * i], &coordinates[3 * i] + 3), form, order);
  }
  text += "\n$EndNodes\n$Elements\n4\n";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int tag = static_cast<int>(i) + 1;
    const std::vector<int> head =
        form == Form::text ? std::vector{tag, gmsh_types[i], 2, 1, 1} : std::vector{gmsh_types[i], 1, 2, tag, 1, 1};
    text += numbers<std::int32_t>(head, form, order) + numbers<std::int32_t>(tags(cells[i]), form, order);
  }
  return text + "\n$EndElements\n";
}

/// Two blocks of nodes, the second one with parameters (of a surface).
inline std::string gmsh_4(Form form, std::endian order = std::endian::little) {
  const auto ints = [&](const std::vector<int>& values) { return numbers<std::int32_t>(values, form, order); };
  const auto sizes = [&](const std::vector<int>& values) { return numbers<std::uint64_t>(values, form, order); };
  const auto reals = [&](const std::vector<double>& values) { return numbers<double>(values, form, order); };
  std::string text = gmsh_start("4.1", form, order) + "$Nodes\n" + sizes({2, 5, 2, 100});
  text += ints({3, 1, 0}) + sizes({4}) + sizes({gmsh_tags.begin(), gmsh_tags.begin() + 4});
  text += reals({coordinates.begin(), coordinates.begin() + 12});
  text += ints({2, 1, 1}) + sizes({1}) + sizes({gmsh_tags[4]}) + reals({coordinates.begin() + 12, coordinates.end()});
  text += reals({0.5, 0.5}) + "\n$EndNodes\n$Elements\n" + sizes({4, 4, 1, 4});
  for (std::size_t i = 0; i < cells.size(); ++i) {
    text += ints({3, 1, gmsh_types[i]}) + sizes({1}) + sizes({static_cast<int>(i) + 1}) + sizes(tags(cells[i]));
  }
  return text + "\n$EndElements\n";
}

}  // namespace sinew::io::samples
