// Register allocation and selection of instructions.
//
// Values are computed in the order of the program. A register is freed where its value is read for
// the last time; where all are taken, the value that is read last is stored (Belady 1966), which is
// the best choice for straight-line code.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

#include <hamel/framework/graph/encoder_x86.hpp>
#include <hamel/framework/graph/machine_x86.hpp>
#include <hamel/framework/graph/straight_code.hpp>

namespace hamel::graph {
namespace {

constexpr int kRegisters = 16;
constexpr int kNever = std::numeric_limits<int>::max();

class Emission {
 public:
  Emission(const Program& program, int lanes, int stride)
      : code_(straighten(program)),
        inputs_(program.first_constant()),
        first_result_(program.first_result()),
        lanes_(lanes),
        stride_(stride),
        encoder_(lanes > 1),
        values_(static_cast<size_t>(code_.values)) {
    std::fill(std::begin(held_), std::end(held_), -1);
    fill_table(program);
    list_reads();
    next_result_.assign(code_.results.size(), -1);
    for (size_t k = code_.results.size(); k-- > 0;) {
      next_result_[k] = std::exchange(value(code_.results[k]).result, static_cast<int>(k));
    }
    if (code_.largest_angle >= 0) slots_ = 1;
  }

  EmittedCode run() {
    segments_.push_back({0, {}});
    const auto& instructions = code_.instructions;
    for (now_ = 0; now_ < static_cast<int>(instructions.size()); ++now_) {
      const auto& [value, instruction] = instructions[static_cast<size_t>(now_)];
      if (is_call(instruction.op)) call(value, instruction);
      else compute(value, instruction);
    }
    for (size_t k = 0; k < code_.results.size(); ++k) {
      const Value& v = values_[static_cast<size_t>(code_.results[k])];
      if (v.is_computed) continue;  // and stored: others are inputs, constants or results of calls
      encoder_.load(0, home(code_.results[k]));
      encoder_.store(result(static_cast<int>(k)), 0);
    }
    encoder_.end();
    return {encoder_.bytes(), std::move(segments_), std::move(table_), static_cast<size_t>(slots_),
            code_.largest_angle >= 0};
  }

 private:
  struct Value {
    int vector = -1;  // register
    int slot = -1;
    int read = -1;    // the next one, in reads_
    int result = -1;  // the first one that it is; further ones in next_result_
    bool is_computed = false;
  };
  struct Read {
    int at, next;
  };

  Value& value(int v) { return values_[static_cast<size_t>(v)]; }
  const Value& value(int v) const { return values_[static_cast<size_t>(v)]; }

  // ---- table: masks, then constants; a mask has 16 bytes also where scalar
  void fill_table(const Program& program) {
    const auto repeat = [&](double x, int times) {
      table_.insert(table_.end(), static_cast<size_t>(times), x);
    };
    for (const std::uint64_t bits : {kSign, ~kSign, ~std::uint64_t{0}}) {
      repeat(std::bit_cast<double>(bits), std::max(lanes_, 2));
    }
    constants_ = static_cast<int>(table_.size());
    for (const double constant : program.constants()) repeat(constant, lanes_);
  }
  static constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  enum Mask { kSignMask, kAbsMask, kOnesMask };
  Operand mask(Mask m) const { return memory(Base::table, m * std::max(lanes_, 2) * 8); }

  // ---- reads of each value, in order
  void list_reads() {
    const auto& instructions = code_.instructions;
    reads_.reserve(instructions.size() * 2);
    for (int t = static_cast<int>(instructions.size()) - 1; t >= 0; --t) {
      const Instruction& i = instructions[static_cast<size_t>(t)].second;
      for (const int v : {i.c, i.b, i.a}) {
        if (v < 0 || next_read(v) == t) continue;
        reads_.push_back({t, value(v).read});
        value(v).read = static_cast<int>(reads_.size()) - 1;
      }
    }
  }
  int next_read(int v) const {
    return value(v).read < 0 ? kNever : reads_[static_cast<size_t>(value(v).read)].at;
  }
  int read_after_next(int v) const {
    if (value(v).read < 0) return kNever;
    const int after = reads_[static_cast<size_t>(value(v).read)].next;
    return after < 0 ? kNever : reads_[static_cast<size_t>(after)].at;
  }
  void mark_read(const Instruction& i) {
    for (const int v : {i.a, i.b, i.c}) {
      if (v >= 0 && next_read(v) == now_)
        value(v).read = reads_[static_cast<size_t>(value(v).read)].next;
    }
  }
  void free_unread(const Instruction& i) {
    for (const int v : {i.a, i.b, i.c}) {
      if (v < 0 || next_read(v) != kNever) continue;
      release(v);
      if (value(v).slot >= 0 && (value(v).is_computed || value(v).result < 0)) {
        free_slots_.push_back(value(v).slot);
        value(v).slot = -1;
      }
    }
  }

  // ---- memory
  Operand home(int v) const {
    if (v < inputs_) return memory(Base::arguments, v * stride_ * 8);
    if (v < first_result_) return memory(Base::table, (constants_ + (v - inputs_) * lanes_) * 8);
    return memory(Base::work, value(v).slot * lanes_ * 8);
  }
  bool has_home(int v) const { return v < first_result_ || value(v).slot >= 0; }
  Operand result(int k) const { return memory(Base::results, k * stride_ * 8); }
  int new_slot() {
    if (free_slots_.empty()) return slots_++;
    const int slot = free_slots_.back();
    free_slots_.pop_back();
    return slot;
  }
  void store_in_slot(int v) {
    value(v).slot = new_slot();
    encoder_.store(home(v), value(v).vector);
  }

  // ---- registers
  void release(int v) {
    if (value(v).vector >= 0) held_[value(v).vector] = -1;
    value(v).vector = -1;
  }
  void hold(int v, int vector) {
    value(v).vector = vector;
    held_[vector] = v;
  }
  // A register other than these three, free or freed of the value that is read last.
  int take(int not_1, int not_2 = -1, int not_3 = -1) {
    int last = -1, latest = -1;
    for (int r = 0; r < kRegisters; ++r) {
      if (r == not_1 || r == not_2 || r == not_3) continue;
      if (held_[r] < 0) return r;
      int at = next_read(held_[r]);
      if (at < kNever && has_home(held_[r])) at += kWorthOfAStore;
      if (at > latest) {
        latest = at;
        last = r;
      }
    }
    const int v = held_[last];
    if (!has_home(v) && next_read(v) < kNever) store_in_slot(v);
    release(v);
    return last;
  }
  // Register of a value, loaded where it is in memory.
  int load(int v, int not_1 = -1, int not_2 = -1) {
    if (value(v).vector < 0) {
      const int r = take(not_1, not_2);
      encoder_.load(r, home(v));
      hold(v, r);
    }
    return value(v).vector;
  }
  int vector_of(int v) const { return v < 0 ? -1 : value(v).vector; }
  Operand operand(int v) const {
    return value(v).vector >= 0 ? vector_register(value(v).vector) : home(v);
  }
  bool is_read_soon_again(int v) const {
    return vector_of(v) < 0 && read_after_next(v) < now_ + kSoon;
  }

  // ---- instructions
  void compute(int v, const Instruction& i) {
    int to;
    if (i.op == Op::select) to = select(i);
    else if (operand_count(i.op) == 2) to = binary(i);
    else to = unary(i);
    hold(v, to);
    for (int k = value(v).result; k >= 0; k = next_result_[static_cast<size_t>(k)]) {
      encoder_.store(result(k), to);
    }
    value(v).is_computed = true;
    if (v == code_.largest_angle) encoder_.store(memory(Base::work, 0), to);
    if (next_read(v) == kNever) release(v);
  }

  int unary(const Instruction& i) {
    const bool by_bits = i.op == Op::negate || i.op == Op::abs || i.op == Op::opposite;
    if (by_bits || is_read_soon_again(i.a)) load(i.a);
    const Operand a = operand(i.a);
    mark_read(i);
    const int to = a.vector >= 0 && next_read(i.a) == kNever ? a.vector : take(a.vector);
    free_unread(i);  // after take(), which could store into a slot that is still to be read
    switch (i.op) {
      case Op::negate: encoder_.bit_xor(to, a.vector, mask(kSignMask)); break;
      case Op::abs: encoder_.bit_and(to, a.vector, mask(kAbsMask)); break;
      case Op::opposite: encoder_.bit_xor(to, a.vector, mask(kOnesMask)); break;
      case Op::sqrt: encoder_.sqrt(to, a); break;
      default: encoder_.round(to, a); break;
    }
    return to;
  }

  int binary(Instruction i) {
    if (i.op == Op::min || i.op == Op::max) std::swap(i.a, i.b);  // a < b ? a : b of the machine
    const bool symmetric = i.op == Op::add || i.op == Op::multiply;
    if (symmetric && vector_of(i.a) < 0 && vector_of(i.b) >= 0) std::swap(i.a, i.b);
    const int a = load(i.a, vector_of(i.b));
    const bool by_bits = i.op == Op::both || i.op == Op::either;
    if (by_bits || is_read_soon_again(i.b)) load(i.b, a);
    const Operand b = operand(i.b);
    mark_read(i);
    int to;
    if (next_read(i.a) == kNever) to = a;
    else if (b.vector >= 0 && next_read(i.b) == kNever) to = b.vector;
    else to = take(a, b.vector);
    free_unread(i);
    encode(i.op, to, a, b);
    return to;
  }
  void encode(Op op, int to, int a, Operand b) {
    using Predicate = Encoder::Predicate;
    switch (op) {
      case Op::add: return encoder_.add(to, a, b);
      case Op::subtract: return encoder_.subtract(to, a, b);
      case Op::multiply: return encoder_.multiply(to, a, b);
      case Op::divide: return encoder_.divide(to, a, b);
      case Op::min: return encoder_.min(to, a, b);
      case Op::max: return encoder_.max(to, a, b);
      case Op::less: return encoder_.compare(Predicate::less, to, a, b);
      case Op::less_equal: return encoder_.compare(Predicate::less_equal, to, a, b);
      case Op::equal: return encoder_.compare(Predicate::equal, to, a, b);
      case Op::both: return encoder_.bit_and(to, a, b);
      default: return encoder_.bit_or(to, a, b);
    }
  }

  int select(const Instruction& i) {
    const int condition = load(i.a, vector_of(i.b), vector_of(i.c));
    const int otherwise = load(i.c, condition, vector_of(i.b));
    if (lanes_ == 1) load(i.b, condition, otherwise);  // a load of 16 bytes could leave the array
    const Operand then = operand(i.b);
    mark_read(i);
    const int to = next_read(i.c) == kNever ? otherwise : take(condition, otherwise, then.vector);
    free_unread(i);
    encoder_.blend(to, condition, then, otherwise);
    return to;
  }

  // ---- functions of the C library
  void call(int v, const Instruction& i) {
    store_registers();
    const LaneAddress a = address(i.a), b = i.b < 0 ? a : address(i.b);
    mark_read(i);
    free_unread(i);
    value(v).slot = new_slot();
    segments_.back().calls.push_back({i.op, a, b, static_cast<size_t>(value(v).slot * lanes_)});
    const size_t next = static_cast<size_t>(now_) + 1;
    if (next < code_.instructions.size() && is_call(code_.instructions[next].second.op)) return;
    encoder_.end();
    segments_.push_back({encoder_.bytes().size(), {}});
  }
  void store_registers() {
    for (int r = 0; r < kRegisters; ++r) {
      const int v = held_[r];
      if (v < 0) continue;
      if (!has_home(v)) store_in_slot(v);
      release(v);
    }
  }
  LaneAddress address(int v) const {
    using Base = LaneAddress::Base;
    if (v < inputs_) return {Base::arguments, static_cast<size_t>(v * stride_)};
    if (v < first_result_) {
      return {Base::table, static_cast<size_t>(constants_ + (v - inputs_) * lanes_)};
    }
    return {Base::work, static_cast<size_t>(value(v).slot * lanes_)};
  }

  static constexpr int kWorthOfAStore =
      10;  // instructions: a value that has a home is dropped before one that has none
  static constexpr int kSoon = 24;  // instructions

  const StraightCode code_;
  const int inputs_, first_result_, lanes_, stride_;
  Encoder encoder_;
  std::vector<Segment> segments_;
  std::vector<double> table_;
  int constants_ = 0;  // in the table
  std::vector<Value> values_;
  std::vector<Read> reads_;
  std::vector<int> next_result_;
  int held_[kRegisters];  // value of each register, -1: free
  std::vector<int> free_slots_;
  int slots_ = 0, now_ = 0;
};

}  // namespace

EmittedCode emit(const Program& program, int lanes, int stride) {
  return Emission(program, lanes, stride).run();
}

}  // namespace hamel::graph
