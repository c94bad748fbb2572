// Assembly: the rows of the parts, those of them that are independent, and where they have to
// agree.
#include <algorithm>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>
#include <hamel/systems/mechanisms/starts/mobility.hpp>

namespace hamel {

using namespace mechanisms;

// Labels of all rows: contacts, loops, couplings, agreements, one for each prescribed joint.
std::vector<RowLabel> Assembly::rows_in_words(const std::vector<RowInfo>& rows) const {
  std::vector<RowLabel> out;
  const size_t others = rows.size() - parts_.rates_.size();
  for (const RowInfo& row : rows) {
    const auto say = [&](const Part& part, const std::string& kind) {
      out.push_back({part.where, fmt::format("{} '{}' ({})", kind, part.name, row.meaning)});
    };
    if (out.size() >= others) {
      say(parts_.rates_[out.size() - others], "prescribed");
      continue;
    }
    const auto find = [&](const auto& parts, const std::string& kind) {
      for (const auto& part : parts)
        if (part.name == row.part) say(part, kind);
    };
    const auto find_of_kind = [&](const auto& parts) {
      for (const auto& part : parts)
        if (part.name == row.part) say(part, part.kind);
    };
    find_of_kind(parts_.contacts_);
    find_of_kind(parts_.loops_);
    if (row.slips && !row.length) {
      find(parts_.walls_, "wall");
      for (const auto& part : parts_.joints_)
        if (is_of_joint(row.part, part)) say(part, "joint");
      continue;
    }
    find(parts_.couplings_, "coupling");
    if (row.part == kAgreement)
      out.push_back({"", fmt::format("{} ({})", kAgreement, row.meaning)});
  }
  return out;
}

// Refuses a row that contradicts others, and one that repeats others, or drops it with a note;
// always drops one that depends on inputs, since they may agree.
void Assembly::look_at_repeat(int row, const Repeat& repeat, const std::vector<RowLabel>& rows,
                              bool drop) {
  const auto driven = [&](int one) {
    const auto i = static_cast<size_t>(one) + parts_.rates_.size();
    return i >= rows.size() && !parts_.rates_[i - rows.size()].rate;
  };
  const std::string list = in_words(repeat.others, rows);
  const RowLabel& said = rows[static_cast<size_t>(row)];
  const bool inputs = driven(row) || std::ranges::any_of(repeat.others, driven);
  if (repeat.contradicts && !inputs) {
    mistakes_.push_back(said.where + contradiction(said, list) +
                        (list.empty() ? "; leave it out" : "; leave one of them out"));
    return;
  }
  const std::string text =
      list.empty()
          ? fmt::format("{} constrains nothing: no joint moves its body that way", said.what)
          : fmt::format("{} is implied by {}", said.what, list);
  if (drop || inputs)
    model_.notes.push_back(
        "row dropped: " + text +
        (list.empty() ? "" : fmt::format("; the reactions there include that of {}", said.what)));
  else
    mistakes_.push_back(fmt::format(
        "{}redundant row: {}; {}, or redundant = \"drop\"", said.where, text,
        list.empty() ? "leave it out" : "take a part with fewer rows (a roller for a wheel)"));
}

// Rows of phi that are zero at all places are left out without notice, but not all of a loop:
// refuses such a loop, or drops it with a note.
void Assembly::look_at_idle_loops(const Redundancy& redundancy, const std::vector<int>& slipping,
                                  const std::vector<RowInfo>& words, bool drop) {
  for (const auto& loop : parts_.loops_) {
    const auto speaks = [&](size_t i) {
      const int row = static_cast<int>(i);
      return words[i].part == loop.name &&
             (redundancy.repeats.contains(row) || std::ranges::count(redundancy.rows, row) > 0 ||
              std::ranges::count(slipping, row) > 0);
    };
    bool some = false;
    for (size_t i = 0; i < words.size(); ++i) some = some || speaks(i);
    if (some) continue;
    const std::string text = "constrains nothing: the joints between its bodies hold it already";
    if (drop)
      model_.notes.push_back(fmt::format("{} '{}' dropped: {}", loop.kind, loop.name, text));
    else wrong(loop, loop.kind, text + "; leave it out");
  }
}

void Assembly::look_at_redundant(const Redundancy& redundancy, const std::vector<int>& slipping,
                                 const std::vector<RowInfo>& words) {
  const Part& policy = parts_.redundant_;
  const bool drop = policy.name == "drop";
  if (!drop && policy.name != "refuse")
    mistakes_.push_back(policy.where + unknown_name("redundant", policy.name, {"drop", "refuse"}));
  for (const auto& [row, repeat] : redundancy.repeats)
    look_at_repeat(row, repeat, rows_said_, drop);
  look_at_idle_loops(redundancy, slipping, words, drop);
  stop_at_mistakes();
}

// The rows that are independent, near the drawn pose and near the start.
void Assembly::find_rows(const std::shared_ptr<Multibody>& system,
                         const std::vector<int>& giving_way) {
  rows_said_ = rows_in_words(system->row_info());
  starts_ = std::make_shared<Starts>(system, parts_.name_, model_.group.columns, model_.rates,
                                     rows_said_);
  std::vector<int> others = giving_way, kept;
  for (const int row : rows_that_constrain(*system, system->drawn()))
    if (system->row_info()[static_cast<size_t>(row)].slips) kept.push_back(row);
  for (size_t row = 0; row < system->row_info().size(); ++row)
    if (system->row_info()[row].slips) others.push_back(static_cast<int>(row));
  redundancy_ =
      find_redundancy(*system, {system->drawn(), start_configuration(*system, *starts_)}, others);
  look_at_redundant(redundancy_, kept, system->row_info());
  kept.insert(kept.end(), redundancy_.rows.begin(), redundancy_.rows.end());
  std::ranges::sort(kept);
  system->keep(kept);
  std::vector<int> implied;
  for (const auto& [row, repeat] : redundancy_.repeats) implied.push_back(row);
  system->imply(implied);
  if (std::ranges::all_of(parts_.rates_, [](const auto& part) { return bool(part.rate); })) return;
  for (const ImpliedRow& row : system->implied_rows(0, system->drawn().data()))
    if (!row.sum.empty())
      model_.notes.push_back(
          fmt::format("{} has to be {}: a run whose inputs say otherwise ends", row.name, row.sum));
}

std::shared_ptr<Multibody> Assembly::system_of(ConstraintRows rows, Forces forces) {
  std::vector<std::shared_ptr<const Geometry>> factors;
  for (const Link& link : links_) factors.push_back(link.joint->geometry());
  const auto geometry = std::make_shared<ProductGeometry>(factors);
  const Tree tree(links_);
  auto out = std::make_shared<Multibody>(tree, rows, forces, geometry);
  check_contacts(*out);
  stop_at_mistakes();
  find_rows(out, {});
  if (!moves_at_this_pose_alone(*out, out->drawn())) return out;
  const auto others = static_cast<int>(rows_said_.size() - rows.prescribed.size());
  std::vector<int> kept = out->holding(), all = kept;
  for (const auto& [row, repeat] : redundancy_.repeats) all.push_back(row);
  for (std::vector<int>* some : {&kept, &all}) {
    std::ranges::sort(*some);
    std::erase_if(*some, [&](int row) { return row >= others; });
  }
  rows.agreements = out->find_agreements(all, poses_around(*out, out->drawn()));
  if (rows.agreements.empty()) return out;
  for (const auto& [row, velocity] : rows.agreements.front().pivots) {
    std::erase(kept, row);
    std::erase(all, row);
  }
  out = std::make_shared<Multibody>(tree, std::move(rows), std::move(forces), geometry);
  find_rows(out, all);
  model_.notes.push_back(fmt::format(
      "wheels are steered one by one: their axles meet in one point, which is a holonomic row "
      "({}); rows that follow, whose reactions are those of the others: {}",
      kAgreement, in_words(kept, rows_said_)));
  return out;
}

}  // namespace hamel
