// An element as a block of doubles.
#pragma once

#include <cstring>

namespace hamel {

/// An element as doubles: its bytes. Products specialise it, factor after factor.
template <class G>
struct Packing {
  using Element = typename G::template Element<double>;
  static constexpr int size = static_cast<int>((sizeof(Element) + 7) / 8);
  static Element load(const double* from) {
    Element g = G::template identity<double>();
    std::memcpy(static_cast<void*>(&g), from, sizeof(Element));
    return g;
  }
  static void store(const Element& g, double* to) {
    std::memcpy(to, static_cast<const void*>(&g), sizeof(Element));
  }
};

}  // namespace hamel
