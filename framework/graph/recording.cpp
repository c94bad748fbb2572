// Nodes of a recording, each once.
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {
namespace {

thread_local Recording* current_recording = nullptr;

}  // namespace

Recording::Recording() : table_(1024, -1), outer_(current_recording) { current_recording = this; }
Recording::~Recording() { end(); }

void Recording::end() {
  if (!std::exchange(ended_, true)) current_recording = outer_;
}

Recording& Recording::current() {
  if (!current_recording) throw std::logic_error("graph::Number: no Recording in this thread");
  return *current_recording;
}

Number Recording::input(std::string name) {
  Number out;
  out.node_ = share({Op::input, static_cast<int>(inputs_.size()), -1, -1, 0});
  inputs_.push_back(std::move(name));
  return out;
}

Number Recording::number(int node) const {
  const Node& n = nodes_[static_cast<size_t>(node)];
  if (n.op == Op::constant) return n.value;
  Number out;
  out.node_ = node;
  return out;
}

Condition Recording::condition(int node) const {
  Condition out(false);
  out.node_ = node;
  return out;
}

int Recording::node_of(const Number& x) {
  return x.constant() ? share({Op::constant, -1, -1, -1, x.value()}) : x.node();
}

Number Recording::make(Op op, const Number& a, const Number& b) {
  const int first = node_of(a), second = operand_count(op) == 2 ? node_of(b) : -1;
  return number(share({op, first, second, -1, 0}));
}

Number Recording::make_select(const Condition& c, const Number& a, const Number& b) {
  const int first = node_of(a), second = node_of(b);
  return number(share({Op::select, c.node(), first, second, 0}));
}

Condition Recording::compare(Op op, const Number& a, const Number& b) {
  const int first = node_of(a), second = node_of(b);
  return condition(share({op, first, second, -1, 0}));
}

Condition Recording::combine(Op op, const Condition& a, const Condition& b) {
  return condition(share({op, a.node(), operand_count(op) == 2 ? b.node() : -1, -1, 0}));
}

// ---- sharing ----

namespace {

std::uint64_t mixed(std::uint64_t x) {  // the finaliser of MurmurHash3
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdULL;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return x ^ (x >> 33);
}

size_t hash(const Node& n) {
  const auto bits = [](int i) { return std::uint64_t(std::uint32_t(i)); };
  const std::uint64_t first = bits(n.a) | bits(n.b) << 32, second = bits(n.c) | std::uint64_t(n.op)
                                                                                    << 32;
  return static_cast<size_t>(
      mixed(first ^ mixed(second ^ mixed(std::bit_cast<std::uint64_t>(n.value)))));
}

bool are_equal(const Node& x, const Node& y) {
  return x.op == y.op && x.a == y.a && x.b == y.b && x.c == y.c &&
         std::bit_cast<std::uint64_t>(x.value) == std::bit_cast<std::uint64_t>(y.value);
}

}  // namespace

int Recording::share(const Node& node) {
  if (nodes_.size() * 2 >= table_.size()) grow();
  const size_t last = table_.size() - 1;
  size_t place = hash(node) & last;
  for (; table_[place] >= 0; place = (place + 1) & last) {
    if (are_equal(nodes_[static_cast<size_t>(table_[place])], node)) return table_[place];
  }
  nodes_.push_back(node);
  return table_[place] = static_cast<int>(nodes_.size()) - 1;
}

void Recording::grow() {
  table_.assign(table_.size() * 2, -1);
  const size_t last = table_.size() - 1;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    size_t place = hash(nodes_[i]) & last;
    while (table_[place] >= 0) place = (place + 1) & last;
    table_[place] = static_cast<int>(i);
  }
}

}  // namespace hamel::graph
