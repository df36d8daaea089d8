#pragma once

namespace sinew::linalg {

/// Of the numbers that a factor keeps.
enum class Precision { float64, float32 };

}  // namespace sinew::linalg
