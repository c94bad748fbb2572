// Encoder of the x86-64 instructions that programs use: AVX on one double (scalar) or four
// (packed). Not installed.
//
// Source: Intel 64 and IA-32 Architectures Software Developer's Manual, volume 2, 2.3 (VEX) and the
// pages named.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hamel::graph {

/// General registers that hold addresses, by their numbers.
enum class Base : int { table = 1, work = 2, results = 6, arguments = 7 };  // rcx rdx rsi rdi

/// Operand: a vector register 0 to 15, or memory at base + displacement (bytes), of any alignment.
struct Operand {
  int vector = -1;
  Base base = Base::table;
  int displacement = 0;
};
inline Operand vector_register(int number) { return {number, Base::table, 0}; }
inline Operand memory(Base base, int displacement) { return {-1, base, displacement}; }

/// Instructions as bytes, in the order of the calls. Operands: to = a op b.
class Encoder {
 public:
  explicit Encoder(bool packed) : packed_(packed) { bytes_.reserve(4096); }

  void add(int to, int a, Operand b) { arithmetic(0x58, to, a, b); }       // VADDSD VADDPD
  void multiply(int to, int a, Operand b) { arithmetic(0x59, to, a, b); }  // VMULSD VMULPD
  void subtract(int to, int a, Operand b) { arithmetic(0x5C, to, a, b); }  // VSUBSD VSUBPD
  void min(int to, int a, Operand b) {
    arithmetic(0x5D, to, a, b);
  }  // a < b ? a : b; VMINSD VMINPD
  void divide(int to, int a, Operand b) { arithmetic(0x5E, to, a, b); }  // VDIVSD VDIVPD
  void max(int to, int a, Operand b) {
    arithmetic(0x5F, to, a, b);
  }  // a > b ? a : b; VMAXSD VMAXPD

  /// Ordered and quiet: false where an operand is not a number.
  enum class Predicate : std::uint8_t { equal = 0x00, less = 0x11, less_equal = 0x12 };
  /// All bits of a lane set, or none. VCMPSD VCMPPD.
  void compare(Predicate p, int to, int a, Operand b) {
    arithmetic(0xC2, to, a, b);
    byte(static_cast<std::uint8_t>(p));
  }
  // Bits; memory operands have 16 bytes also where scalar. VANDPD VORPD VXORPD.
  void bit_and(int to, int a, Operand b) { instruction({k66, k0F, 0x54}, to, a, b); }
  void bit_or(int to, int a, Operand b) { instruction({k66, k0F, 0x56}, to, a, b); }
  void bit_xor(int to, int a, Operand b) { instruction({k66, k0F, 0x57}, to, a, b); }
  /// mask ? a : b, by the sign of mask; a in memory has 16 bytes also where scalar. VBLENDVPD.
  void blend(int to, int mask, Operand a, int b) {
    instruction({k66, k0F3A, 0x4B}, to, b, a);
    byte(static_cast<std::uint8_t>(mask << 4));
  }
  /// VSQRTSD VSQRTPD.
  void sqrt(int to, Operand a) { arithmetic(0x51, to, second_source(to, a), a); }
  /// To the nearest integer as MXCSR requires, without the exception "inexact". VROUNDSD VROUNDPD.
  void round(int to, Operand a) {
    const std::uint8_t code = packed_ ? 0x09 : 0x0B;
    instruction({k66, k0F3A, code}, to, second_source(to, a), a);
    byte(0x0C);
  }
  /// VMOVSD VMOVUPD.
  void load(int to, Operand from) { arithmetic(0x10, to, kNone, from); }
  void store(Operand to, int from) { arithmetic(0x11, from, kNone, to); }
  /// VZEROUPPER where packed; RET.
  void end() {
    if (packed_) bytes_.insert(bytes_.end(), {0xC5, 0xF8, 0x77});
    byte(0xC3);
  }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  enum Prefix : std::uint8_t { k66 = 1, kF2 = 3 };
  enum Map : std::uint8_t { k0F = 1, k0F3A = 3 };
  struct Code {
    Prefix prefix;
    Map map;
    std::uint8_t opcode;
  };
  static constexpr int kNone = 0;  // encoded as 1111

  void arithmetic(std::uint8_t opcode, int r, int v, Operand m) {
    instruction({packed_ ? k66 : kF2, k0F, opcode}, r, v, m);
  }
  // Scalar forms take the upper half of the result from a second source: a register that is at
  // hand.
  int second_source(int to, Operand a) const {
    if (packed_) return kNone;
    return a.vector >= 0 ? a.vector : to;
  }
  // VEX with three bytes, the opcode, ModRM, the displacement.
  void instruction(Code code, int r, int v, Operand m) {
    const bool is_register = m.vector >= 0;
    const int b = is_register ? m.vector : static_cast<int>(m.base);
    byte(0xC4);
    byte(inverted(r >> 3) << 7 | 1 << 6 | inverted(b >> 3) << 5 | code.map);  // R X B, map
    byte((~v & 15) << 3 | (packed_ ? 4 : 0) | code.prefix);                   // W = 0, vvvv, L, pp
    byte(code.opcode);
    const int mod_rm = (r & 7) << 3 | (b & 7);
    if (is_register) return byte(0xC0 | mod_rm);
    const bool is_short = m.displacement >= -128 && m.displacement < 128;
    byte((is_short ? 0x40 : 0x80) | mod_rm);
    const auto displacement = static_cast<std::uint32_t>(m.displacement);
    for (int k = 0; k < (is_short ? 1 : 4); ++k)
      byte(static_cast<int>(displacement >> 8 * k & 0xFF));
  }
  static int inverted(int bit) { return ~bit & 1; }
  void byte(int value) { bytes_.push_back(static_cast<std::uint8_t>(value)); }

  bool packed_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace hamel::graph
