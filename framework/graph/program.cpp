#include <hamel/framework/graph/program.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <stdexcept>

#include <hamel/framework/graph/sine.hpp>

namespace hamel::graph {
namespace {

std::array<int, 3> operands(const Node& n) {
  if (operand_count(n.op) == 0) return {-1, -1, -1};
  return {n.a, n.b, n.c};
}

std::vector<bool> live_nodes(const Recording& recording, const std::vector<Number>& outputs) {
  const std::vector<Node>& nodes = recording.nodes();
  std::vector<bool> live(nodes.size(), false);
  for (const Number& x : outputs) {
    if (!x.constant()) live[static_cast<size_t>(x.node())] = true;
  }
  for (size_t i = nodes.size(); i-- > 0;) {
    if (!live[i]) continue;
    for (const int k : operands(nodes[i])) {
      if (k >= 0) live[static_cast<size_t>(k)] = true;
    }
  }
  return live;
}

bool has_sine(const Recording& recording, const std::vector<bool>& live) {
  const std::vector<Node>& nodes = recording.nodes();
  for (size_t i = 0; i < nodes.size(); ++i)
    if (live[i] && (nodes[i].op == Op::sin || nodes[i].op == Op::cos)) return true;
  return false;
}

// Recording of the live nodes with sines and cosines expanded; it is current while this object
// exists.
class Expansion {
 public:
  Expansion(const Recording& from, const std::vector<Number>& outputs) {
    for (const std::string& name : from.inputs()) inputs_.push_back(to_.input(name));
    const std::vector<bool> live = live_nodes(from, outputs);
    copies_.resize(live.size());
    for (size_t i = 0; i < live.size(); ++i) {
      if (live[i]) copy(from.nodes()[i], copies_[i]);
    }
    for (const Number& x : outputs) outputs_.push_back(x.constant() ? x : at(x.node()).number);
  }
  const Recording& recording() const { return to_; }
  const std::vector<Number>& outputs() const { return outputs_; }

 private:
  struct Copy {
    Number number;
    Condition condition = false;
  };
  const Copy& at(int node) const { return copies_[static_cast<size_t>(node)]; }

  void copy(const Node& n, Copy& out) {
    switch (n.op) {
      case Op::constant: out.number = n.value; return;
      case Op::input: out.number = inputs_[static_cast<size_t>(n.a)]; return;
      case Op::sin:
      case Op::cos: out.number = expand(n.op, n.a); return;
      case Op::both:
      case Op::either:
        out.condition = to_.combine(n.op, at(n.a).condition, at(n.b).condition);
        return;
      case Op::opposite: out.condition = to_.combine(n.op, at(n.a).condition, false); return;
      case Op::select:
        out.number = to_.make_select(at(n.a).condition, at(n.b).number, at(n.c).number);
        return;
      default: break;
    }
    const Number& a = at(n.a).number;
    const Number b = n.b < 0 ? Number() : at(n.b).number;
    if (is_condition(n.op)) out.condition = to_.compare(n.op, a, b);
    else out.number = to_.make(n.op, a, b);
  }

  Number expand(Op op, int angle) {
    const Number x = at(angle).number;
    const auto [it, fresh] = angles_.try_emplace(angle);
    if (fresh) it->second = sine_cosine(x);
    return op == Op::sin ? to_.make(Op::sin_beyond, it->second.sine, x)
                         : to_.make(Op::cos_beyond, it->second.cosine, x);
  }

  Recording to_;
  std::vector<Number> inputs_, outputs_;
  std::vector<Copy> copies_;
  std::map<int, SineCosine<Number>> angles_;  // of nodes
};

std::vector<Number> values_of(const Program::Outputs& outputs) {
  std::vector<Number> values;
  for (const auto& output : outputs) values.push_back(output.second);
  return values;
}

}  // namespace

Program::Program(const Recording& recording, const Outputs& outputs) : inputs_(recording.inputs()) {
  for (const auto& output : outputs) outputs_.push_back(output.first);
  const std::vector<Number> values = values_of(outputs);
  if (has_sine(recording, live_nodes(recording, values))) {
    const Expansion expansion(recording, values);
    number_values(expansion.recording(), expansion.outputs());
  } else {
    number_values(recording, values);
  }
}

void Program::number_values(const Recording& recording, const std::vector<Number>& outputs) {
  const std::vector<Node>& nodes = recording.nodes();
  const std::vector<bool> live = live_nodes(recording, outputs);
  std::vector<int> values(nodes.size(), -1);
  const auto value_of = [&](int node) { return node < 0 ? -1 : values[static_cast<size_t>(node)]; };

  for (size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].op == Op::input) values[i] = nodes[i].a;
    if (!live[i] || nodes[i].op != Op::constant) continue;
    values[i] = first_result();
    constants_.push_back(nodes[i].value);
  }
  std::vector<int> of_constants;  // outputs that are constants
  for (const Number& x : outputs) {
    of_constants.push_back(x.constant() ? first_result() : -1);
    if (x.constant()) constants_.push_back(x.value());
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    const Node& n = nodes[i];
    if (!live[i] || n.op == Op::constant || n.op == Op::input) continue;
    values[i] = value_count();
    instructions_.push_back({n.op, value_of(n.a), value_of(n.b), value_of(n.c)});
  }
  for (size_t k = 0; k < outputs.size(); ++k) {
    results_.push_back(of_constants[k] >= 0 ? of_constants[k] : value_of(outputs[k].node()));
  }
}

size_t Program::output(const std::string& name) const {
  const auto it = std::find(outputs_.begin(), outputs_.end(), name);
  if (it == outputs_.end()) throw std::out_of_range("graph::Program: no output '" + name + "'");
  return static_cast<size_t>(it - outputs_.begin());
}

}  // namespace hamel::graph
