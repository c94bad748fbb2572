// Reads the formulas of what is kept: end.X, start.X, max.X, min.X, at(T).X, event.NAME.count and
// event.NAME.time become variables. Part of kept.cpp, not installed.
#pragma once

#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <hamel/framework/ensemble/kept.hpp>
#include <hamel/framework/io/formula_words.hpp>
#include <hamel/framework/run/data/event_formula.hpp>
#include <hamel/framework/run/record/measures.hpp>
#include <hamel/framework/run/run/events.hpp>

namespace hamel::ensemble {

class KeptFormulas::Parser {
 public:
  Parser(KeptFormulas& out, const EnsembleConfig& config, const SystemModel& system)
      : out_(out), config_(config), system_(system) {
    for (const Event& event : events_of(system)) known_events_.push_back(event.name);
    for (const auto& [name, text] : config.events) known_events_.push_back(name);
  }

  /// Adds a column. Throws std::invalid_argument that names what is wrong.
  void column(const std::string& name, const std::string& formula) {
    used_.clear();
    const std::string rewritten = rewrite(formula);
    Formula made{name, used_, {}, {}, 0};
    const bool alone = used_.size() == 1 && rewritten == variable(used_[0]);
    if (!alone) {
      std::vector<std::string> variables;
      for (const size_t atom : used_) variables.push_back(variable(atom));
      made.expression.emplace(rewritten, out_.constants_.behind(variables));
    }
    out_.columns_.push_back({name, alone ? out_.atoms_[made.atoms[0]].unit : "",
                             name == formula ? "of each member" : formula});
    out_.formulas_.push_back(std::move(made));
  }
  /// A time of at(T); std::invalid_argument where it is not one of the run.
  size_t time(double t) {
    const double from = config_.run.from, until = config_.run.until;
    if (!(std::min(from, until) <= t && t <= std::max(from, until)))
      throw std::invalid_argument(
          fmt::format("t = {}: expected a time of the run, {} to {}", t, from, until));
    const auto [known, is_new] = times_.emplace(t, out_.times_.size());
    if (is_new) out_.times_.push_back(t);
    return known->second;
  }
  size_t atom(From from, size_t place, const std::string& quantity, const std::string& text) {
    if (const auto known = atoms_.find(text); known != atoms_.end()) return known->second;
    Atom made{from, "", place, {}};
    if (from == From::time) made.unit = "s";
    else if (from == From::count) made.unit = "1";
    else state(quantity, made);
    out_.wants_start_ = out_.wants_start_ || from == From::start;
    out_.wants_peaks_ = out_.wants_peaks_ || from == From::most || from == From::least;
    out_.atoms_.push_back(std::move(made));
    atoms_.emplace(text, out_.atoms_.size() - 1);
    return out_.atoms_.size() - 1;
  }
  static std::string variable(size_t atom) { return fmt::format("kept_atom_{}", atom); }

 private:
  // The text with each of the names above as a variable.
  std::string rewrite(const std::string& text) {
    std::string out;
    for (size_t i = 0; i < text.size();) {
      if (!may_be_in_name(text[i])) {
        out += text[i++];
        continue;
      }
      size_t end = i;
      while (end < text.size() && may_be_in_name(text[end])) ++end;
      const std::string word = text.substr(i, end - i);
      const size_t from = i;
      i = end;
      if (word == "at" && i < text.size() && text[i] == '(') {
        const double t = number_in_brackets(text, i);
        const size_t place = time(t);
        if (i >= text.size() || text[i] != '.')
          throw std::invalid_argument("expected at(T).X, a time and a quantity");
        ++i;
        out += quantity(From::at, place, "", text, i, from);
      } else if (word.starts_with("event.")) {
        out += event(word);
      } else if (const auto prefix = prefixes().find(word.substr(0, word.find('.') + 1));
                 prefix != prefixes().end()) {
        out += quantity(prefix->second, 0, word.substr(prefix->first.size()), text, i, from);
      } else {
        out += word;
      }
    }
    return out;
  }
  static const std::map<std::string, From>& prefixes() {
    static const std::map<std::string, From> all = {
        {"start.", From::start}, {"end.", From::end}, {"max.", From::most}, {"min.", From::least}};
    return all;
  }
  // "(10)" at i, which goes behind it.
  static double number_in_brackets(const std::string& text, size_t& i) {
    const size_t close = text.find(')', i);
    double out = 0;
    const std::string inside = text.substr(i + 1, close == std::string::npos ? 0 : close - i - 1);
    const auto [end, error] = std::from_chars(inside.data(), inside.data() + inside.size(), out);
    if (error != std::errc() || end != inside.data() + inside.size() || inside.empty())
      throw std::invalid_argument(fmt::format("at({}): expected a time", inside));
    i = close + 1;
    return out;
  }
  // A name, or a formula in brackets at i.
  std::string quantity(From from, size_t place, std::string name, const std::string& text,
                       size_t& i, size_t begin) {
    if (name.empty() && i < text.size() && text[i] == '(') {
      int open = 0;
      size_t end = i;
      do {
        if (text[end] == '(') ++open;
        if (text[end] == ')') --open;
        ++end;
      } while (end < text.size() && open > 0);
      name = text.substr(i, end - i);
      i = end;
    } else if (name.empty()) {
      while (i < text.size() && may_be_in_name(text[i])) name += text[i++];
    }
    return use(atom(from, place, name, text.substr(begin, i - begin)));
  }
  std::string event(const std::string& word) {
    const bool count = word.ends_with(".count"), time = word.ends_with(".time");
    const size_t last = word.rfind('.');
    if ((!count && !time) || last <= 6)
      throw std::invalid_argument(
          fmt::format("'{}': expected event.NAME.count or event.NAME.time", word));
    const std::string name = word.substr(6, last - 6);
    if (std::ranges::find(known_events_, name) == known_events_.end())
      throw std::invalid_argument(unknown_name("event of " + system_.name, name, known_events_));
    const auto own = config_.events.find(name);
    const std::string watched = own == config_.events.end() ? name : own->second;
    const auto it = std::ranges::find(out_.events_, watched);
    const auto place = static_cast<size_t>(it - out_.events_.begin());
    if (it == out_.events_.end()) out_.events_.push_back(watched);
    return use(atom(count ? From::count : From::time, place, "", word));
  }
  // Number of a state, or a formula of some and the constants.
  void state(const std::string& quantity, Atom& out) {
    const std::string text = out_.states_.state().in_formula(quantity);
    const std::vector<std::string>& names = out_.states_.names();
    const auto it = std::ranges::find(names, text);
    check_physics(text);
    if (it != names.end() && !text.empty()) {
      const auto column = static_cast<size_t>(it - names.begin());
      out.number.emplace(column);
      out.unit = out_.states_.columns().unit(column);
      return note(*out.number);
    }
    if (text.empty() || text.front() != '(') {
      std::vector<std::string> known;
      for (const std::string& name : names)
        if (!name.empty()) known.push_back(name);
      throw std::invalid_argument(unknown_name("quantity of " + system_.name, quantity, known));
    }
    out.number.emplace(Expression(text, out_.constants_.behind(names)));
    note(*out.number);
  }

  // Refuses what a system has no number of.
  void check_physics(const std::string& text) const {
    const bool works = StateNames::works(system_);
    for (const std::string& word : words_of(text)) {
      if (word == kWork.name && !works)
        throw std::invalid_argument(
            fmt::format("work: no forces and no moving constraints do work on {}", system_.name));
      if (word.starts_with("lambda") && system_.mechanics->constraint_count() == 0)
        throw std::invalid_argument(
            fmt::format("{}: {} has no constraints, and no reactions", word, system_.name));
    }
  }
  // Notes what is to be followed for it.
  void note(const StateNumber& number) {
    using Of = StateColumns::Of;
    const StateColumns& columns = out_.states_.columns();
    const auto want = [](bool& wanted, bool now) { wanted = wanted || now; };
    const bool works = StateNames::works(system_);
    const auto note_column = [&](size_t i) {
      const Of of = columns.of(i);
      want(out_.wants_start_, of == Of::energy_error);  // against that of the start
      want(out_.wants_solver_, of == Of::iterations || of == Of::residual);
      want(out_.wants_.reactions, of == Of::reaction);
      want(out_.wants_.accelerations, of == Of::acceleration);
      want(out_.wants_.paths, of == Of::path);
      want(out_.wants_.modes, of == Of::mode);
      want(out_.wants_.balance, works && (of == Of::work || of == Of::energy_error));
    };
    for (const size_t i : number.used())
      if (i < columns.size()) columns.each_source(i, note_column);
  }
  static std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> out;
    for (size_t i = 0; i < text.size();) {
      size_t end = i;
      while (end < text.size() && may_be_in_name(text[end])) ++end;
      if (end > i) out.push_back(text.substr(i, end - i));
      i = end + 1;
    }
    return out;
  }

  // Notes that the formula being read uses an atom; its variable.
  std::string use(size_t atom) {
    if (std::ranges::find(used_, atom) == used_.end()) used_.push_back(atom);
    return variable(atom);
  }

  KeptFormulas& out_;
  std::map<std::string, size_t> atoms_;  // by their texts
  std::map<double, size_t> times_;       // as found
  std::vector<size_t> used_;
  const EnsembleConfig& config_;
  const SystemModel& system_;
  std::vector<std::string> known_events_;
};

}  // namespace hamel::ensemble
