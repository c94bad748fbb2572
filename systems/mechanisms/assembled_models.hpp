// Models of one mechanism that were assembled before: a run that is planned, checked or repeated
// with the same parameters assembles and records nothing anew.
#pragma once

#include <functional>
#include <list>
#include <mutex>

#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::mechanisms {

/// The mechanics of a model has one work space, so that a model goes to one user at a time: it is
/// here again when the last copy of it is gone. From any thread.
class AssembledModels {
 public:
  /// A model with these parameters that nobody uses, as if it were new; else what make() returns.
  SystemModel take(const Parameters& given, const std::function<SystemModel()>& make);

 private:
  struct Kept {
    Parameters given;
    SystemModel model;
    long uses;  // of its mechanics, by itself
    bool free() const;
  };
  std::mutex mutex_;
  std::list<Kept> kept_;  // used last first
};

}  // namespace hamel::mechanisms
