// Takes in what members leave, in any order and from any thread, piece by piece. Not installed.
#pragma once

#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/ensemble/ensemble_plan.hpp>
#include <hamel/framework/ensemble/statistics.hpp>

namespace hamel::ensemble {

/// Members that one thread takes at a time, and a line of the journal.
constexpr long kPiece = 16;
inline long pieces_of(long members) { return (members + kPiece - 1) / kPiece; }

/// Takes so many members from first on.
struct Piece {
  long first = 0;
  std::vector<double> rows = {};  // member after member
  std::vector<MemberFailure> failures = {};
  long count(size_t width) const { return static_cast<long>(rows.size() / width); }
};

/// As a line of a journal, and back; std::runtime_error where it does not fit.
std::string line_of(const Piece& piece);
Piece piece_of(const std::string& line);

class Collector {
 public:
  /// The members of a shard; statistics over all at times are for the whole alone.
  Collector(const Plan& plan, EnsembleResult& result);

  /// Is this piece, by its number in the whole, there?
  bool has(long piece) const { return there_[static_cast<size_t>(piece - first_piece_)] != 0; }
  /// Different pieces may be taken by different threads at once. std::runtime_error for one that is
  /// no piece of this shard.
  void take(const Piece& piece);
  /// After all threads: what is there becomes the result's statistics.
  void finish();

 private:
  bool in_range(const Piece& piece, long count) const;
  void follow_chunk(const Piece& piece);
  void name_failures();
  void fill_varied();

  const Plan& plan_;
  EnsembleResult& result_;
  size_t width_, kept_, table_at_;  // table_at_: the first kept column of the table
  bool has_class_;
  long first_piece_;
  std::vector<char> there_;
  std::mutex mutex_;
  // For statistics_at: chunks in flight, and what is done.
  struct Chunk {
    long members = 0;
    std::vector<std::vector<double>> columns;
  };
  size_t hidden_ = 0;
  std::map<long, Chunk> open_;
  std::vector<std::vector<Moments>> chunks_;  // of each quantity
};

}  // namespace hamel::ensemble
