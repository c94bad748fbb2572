#include <hamel/framework/pages/pages.hpp>

#include <functional>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/pages/ensemble_page.hpp>
#include <hamel/framework/pages/page.hpp>
#include <hamel/framework/pages/run_page.hpp>
#include <hamel/framework/pages/study_page.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/study/study.hpp>

namespace hamel {
namespace {

// The page, made once it is known that it can be written.
void write(const std::string& path, const std::function<pages::Page()>& page,
           std::vector<std::string> mistakes = {}) {
  for (std::string& mistake : pages::page_mistakes(path)) mistakes.push_back(std::move(mistake));
  if (!mistakes.empty()) throw ConfigError(mistakes);
  page().write(path);
}

// Mistake of a result that is not whole.
std::vector<std::string> part(const BatchResult& result, const char* work) {
  if (result.shard.count == 1 && result.complete) return {};
  return {std::string("write_page: got ") + (result.complete ? "a shard" : "an unfinished one") +
          ", expected a whole " + work + ": merge() joins shards, run() resumes in the folder"};
}

}  // namespace

void write_page(const Registry& registry, const Result& result, const std::string& path) {
  write(path, [&] { return pages::run_page(registry, result, result.record()); });
}

void write_page(const Registry& registry, const EnsembleResult& result, const std::string& path) {
  write(
      path, [&] { return pages::ensemble_page(registry, result); }, part(result, "ensemble"));
}

void write_page(const StudyResult& result, const std::string& path) {
  write(
      path, [&] { return pages::study_page(result); }, part(result, "study"));
}

}  // namespace hamel
