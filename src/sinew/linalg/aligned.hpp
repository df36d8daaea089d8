// Memory that begins where the widest registers are loaded from one line of the cache.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace sinew::linalg {

inline constexpr std::size_t kLine = 64;  ///< bytes

template <class T>
struct Aligned {
  using value_type = T;
  Aligned() = default;
  template <class Other>
  Aligned(const Aligned<Other>&) {}  // NOLINT(google-explicit-constructor): as allocators must be
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(kLine))); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, std::align_val_t(kLine)); }
  bool operator==(const Aligned&) const { return true; }
};

template <class T>
using AlignedVector = std::vector<T, Aligned<T>>;

}  // namespace sinew::linalg
