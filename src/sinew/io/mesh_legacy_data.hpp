// What stands behind the cells of a legacy VTK file: arrays over its points and cells. Only the array that groups the
// cells is kept.
#pragma once

#include <optional>
#include <string_view>

#include "sinew/io/byte_cursor.hpp"
#include "sinew/io/vtk_cells.hpp"

namespace sinew::io {

/// By the name it has in such a file; nothing for other names.
std::optional<NumberType> legacy_number_type(std::string_view name);

/// To the empty line that ends it; the cursor stands behind the word METADATA.
void skip_metadata(ByteCursor& cursor);

/// Reads on to the end of the file, or to what it does not know, as arrays of strings: nothing else is needed of it.
void read_groups(ByteCursor& cursor, Encoding encoding, VtkCells& cells);

}  // namespace sinew::io
