// The nodes of a time loop: now, the one before and the one that a step makes, in turn.
#pragma once

#include <hamel/framework/schemes/problem.hpp>

namespace hamel {

template <class Problem>
class NodeRing {
 public:
  using Node = hamel::Node<Problem>;
  explicit NodeRing(const Problem& problem) : nodes_{Node(problem), Node(problem), Node(problem)} {}
  NodeRing(const NodeRing&) = delete;
  NodeRing& operator=(const NodeRing&) = delete;

  Node& now() { return *now_; }
  const Node& now() const { return *now_; }
  Node& previous() { return *previous_; }
  const Node& previous() const { return *previous_; }
  Node& next() { return *next_; }
  /// now() was set to an element of the group.
  void count_anew() { products_ = 0; }
  /// Is the element of next() to be normalised? A product of elements is off the group by some
  /// eps: eight of them stay well below 1e-14.
  bool due() const { return products_ == 7; }
  /// next() becomes now(). normalised: where that was due it was done.
  [[gnu::always_inline]] void turn(const Problem& problem, bool normalised = false) {
    if (++products_ == 8) {
      if (!normalised) problem.normalise(next_->g);
      products_ = 0;
    }
    Node* const free = previous_;
    previous_ = now_;
    now_ = next_;
    next_ = free;
  }

 private:
  int products_ = 0;
  Node nodes_[3];
  Node *now_ = &nodes_[0], *previous_ = &nodes_[1], *next_ = &nodes_[2];
};

}  // namespace hamel
