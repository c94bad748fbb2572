#include <hamel/systems/mechanisms/assembled_models.hpp>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <utility>

namespace hamel::mechanisms {
namespace {

constexpr std::size_t kKept = 4;  // for a check, which runs three at once, and one beside

}  // namespace

bool AssembledModels::Kept::free() const {
  const bool alone = model.copies.use_count() == 1 && model.mechanics.use_count() == uses;
  std::atomic_thread_fence(std::memory_order_acquire);  // behind the work of the last user
  return alone;
}

SystemModel AssembledModels::take(const Parameters& given,
                                  const std::function<SystemModel()>& make) {
  const auto same = [&](const Kept& kept) { return kept.given == given && kept.free(); };
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = std::ranges::find_if(kept_, same); found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
      found->model.mechanics->begin();
      return found->model;
    }
  }
  SystemModel out = make();
  out.copies = std::make_shared<char>();
  Kept kept{given, std::move(out), 0};
  kept.uses = kept.model.mechanics.use_count();
  const std::lock_guard lock(mutex_);
  kept_.push_front(std::move(kept));
  SystemModel copy = kept_.front().model;
  if (kept_.size() > kKept) kept_.pop_back();
  return copy;
}

}  // namespace hamel::mechanisms
