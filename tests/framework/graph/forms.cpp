// Random programs of every operation: interpreter, machine code and gcc's build of the exported C
// agree in every bit, in one body and in lanes, at special values, at any address, where executable
// memory is refused, and from 8 threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <thread>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/graph/export_c.hpp>

#include "../temporary_folder.hpp"
#include "random_formula.hpp"

namespace hamel::graph {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Bits; all that are not numbers are one.
std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(std::isnan(x) ? kNaN : x); }

std::vector<std::uint64_t> bits(const std::vector<double>& x) {
  std::vector<std::uint64_t> out;
  for (const double v : x) out.push_back(bits(v));
  return out;
}

// Inputs of one body: usual, special, or large ones.
std::vector<double> random_inputs(std::mt19937& random, size_t n) {
  constexpr double kSpecial[] = {0.0,
                                 -0.0,
                                 1,
                                 -1,
                                 0.5,
                                 1.5,
                                 2.5,
                                 -2.5,
                                 HUGE_VAL,
                                 -HUGE_VAL,
                                 kNaN,
                                 5e-324,
                                 -1e-310,
                                 1.7e308,
                                 -1.7e308,
                                 1e5,
                                 100000.00000000001,
                                 1e22,
                                 0.7853981633974483,
                                 1.5707963267948966,
                                 3.141592653589793,
                                 4503599627370497.5};
  std::uniform_real_distribution<double> usual(-2, 2), large(-3e5, 3e5);
  const int kind = std::uniform_int_distribution(0, 5)(random);
  std::vector<double> x;
  for (size_t i = 0; i < n; ++i) {
    const double special =
        kSpecial[std::uniform_int_distribution<size_t>(0, std::size(kSpecial) - 1)(random)];
    x.push_back(kind == 0 ? special : kind == 1 && i % 2 == 0 ? large(random) : usual(random));
  }
  return x;
}

// Doubles that end `offset` doubles before a page that may not be read: at any address of a double.
class Doubles {
 public:
  Doubles(size_t size, size_t offset) : size_(size), offset_(offset) {
    const size_t page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
    const size_t used = (size + offset + 2) * sizeof(double);
    bytes_ = (used + page - 1) / page * page + page;
    pages_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    EXPECT_NE(pages_, MAP_FAILED);
    double* const end = static_cast<double*>(pages_) + (bytes_ - page) / sizeof(double);
    EXPECT_EQ(mprotect(end, page, PROT_NONE), 0);
    first_ = end - offset - size;
    std::fill(first_ - 2, end, kGuard);
  }
  ~Doubles() { munmap(pages_, bytes_); }
  Doubles(const Doubles&) = delete;
  Doubles& operator=(const Doubles&) = delete;

  double* data() { return first_; }
  bool guards_are_intact() const {
    return std::count(first_ - 2, first_, kGuard) == 2 &&
           std::count(first_ + size_, first_ + size_ + offset_, kGuard) ==
               static_cast<std::ptrdiff_t>(offset_);
  }

 private:
  static constexpr double kGuard = 1.2345e67;
  size_t size_, offset_, bytes_;
  void* pages_;
  double* first_;
};

using Bodies = std::vector<std::vector<double>>;

// Outputs of bodies, `width` at a time.
Bodies outputs(const Code& code, const Bodies& bodies, size_t offset = 0) {
  const size_t w = static_cast<size_t>(code.width()), in = code.program().inputs().size(),
               out = code.program().outputs().size();
  Doubles x(in * w, offset), y(out * w, offset), work(code.work_size(), offset);
  Bodies all;
  for (size_t first = 0; first + w <= bodies.size(); first += w) {
    for (size_t j = 0; j < w; ++j) {
      for (size_t i = 0; i < in; ++i) x.data()[i * w + j] = bodies[first + j][i];
    }
    code(x.data(), y.data(), work.data());
    for (size_t j = 0; j < w; ++j) {
      std::vector<double> one;
      for (size_t k = 0; k < out; ++k) one.push_back(y.data()[k * w + j]);
      all.push_back(one);
    }
  }
  EXPECT_TRUE(x.guards_are_intact() && y.guards_are_intact() && work.guards_are_intact());
  return all;
}

void expect_same_bits(const Bodies& found, const Bodies& expected, const std::string& what) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(bits(found[i]), bits(expected[i])) << what << ", body " << i;
  }
}

struct Case {
  std::shared_ptr<const Program> program;
  Bodies bodies, expected;
};

Case make_case(std::shared_ptr<const Program> program, unsigned seed) {
  std::mt19937 random(seed);
  Case c{std::move(program), {}, {}};
  for (int i = 0; i < 24; ++i) {
    c.bodies.push_back(random_inputs(random, c.program->inputs().size()));
  }
  c.expected = outputs(Code(c.program, 1, Machine::refused), c.bodies);
  return c;
}

Case make_case(unsigned seed) {
  const int sizes[] = {3, 20, 60, 200};
  const int inputs = 1 + static_cast<int>(seed % 7), operations = sizes[seed % 4];
  return make_case(test::random_program(seed, inputs, operations, seed % 3 != 0), seed);
}

constexpr unsigned kCases = 120;

void expect_all_forms_agree(const Case& c, const std::string& what) {
  for (const int width : {1, 4, 8}) {
    for (const Machine machine : {Machine::refused, Machine::allowed}) {
      const Code code(c.program, width, machine);
      EXPECT_EQ(code.is_machine_code(),
                machine == Machine::allowed && machine_code_refused().empty());
      for (const size_t offset : {0, 1, 3}) {
        expect_same_bits(outputs(code, c.bodies, offset), c.expected,
                         what + ", width " + std::to_string(width) +
                             (code.is_machine_code() ? ", machine code" : ", interpreter"));
      }
    }
  }
}

TEST(Forms, OfRandomProgramsAgreeInEveryBit) {
  size_t finite = 0, all = 0;
  for (unsigned seed = 0; seed < kCases; ++seed) {
    const Case c = make_case(seed);
    for (const auto& y : c.expected) {
      for (const double v : y) finite += std::isfinite(v);
      all += y.size();
    }
    expect_all_forms_agree(c, "seed " + std::to_string(seed));
  }
  EXPECT_GT(finite, all / 2);  // the law is about numbers
}

/// Values wait in the work space: 20 to 60 live ones, 16 registers.
TEST(Forms, OfWideProgramsAgreeInEveryBit) {
  for (unsigned seed = 0; seed < kCases; ++seed) {
    expect_all_forms_agree(make_case(test::wide_program(seed, 9, 20 + seed % 41), seed),
                           "wide, seed " + std::to_string(seed));
  }
}

/// Otherwise these tests would compare the interpreter with itself.
TEST(Forms, AreMachineCodeWhereTheProcessorHasAvx) {
#if defined(__x86_64__) && defined(__linux__)
  if (__builtin_cpu_supports("avx") && !std::getenv("HAMEL_NO_MACHINE_CODE")) {
    EXPECT_EQ(machine_code_refused(), "");
  }
#endif
}

TEST(Forms, IncludeExportedC) {
  const hamel::test::TemporaryFolder folder;
  std::vector<Case> cases;
  {
    std::ofstream file(folder / "programs.c");
    file << c_preamble();
    for (unsigned seed = 0; seed < kCases; seed += 2) {
      cases.push_back(make_case(seed));
      file << c_function(*cases.back().program, "program_" + std::to_string(seed));
    }
  }
  const std::string library = folder / "programs.so";
  const std::string command =
      "cc -std=c99 -pedantic -Wall -Werror -O2 -ffp-contract=off -shared -fPIC -o '" + library +
      "' '" + (folder / "programs.c") + "' -lm";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(handle, nullptr) << dlerror();
  for (size_t i = 0; i < cases.size(); ++i) {
    const std::string name = "program_" + std::to_string(2 * i);
    const auto function =
        reinterpret_cast<void (*)(const double*, double*)>(dlsym(handle, name.c_str()));
    ASSERT_NE(function, nullptr);
    Bodies found;
    for (const auto& x : cases[i].bodies) {
      std::vector<double> y(cases[i].program->outputs().size());
      function(x.data(), y.data());
      found.push_back(y);
    }
    expect_same_bits(found, cases[i].expected, name);
  }
  dlclose(handle);
}

TEST(Forms, ExportNamesAsTheyAre) {
  Recording recording;
  const Number x = recording.input("x */ evil\n");
  const Program program(recording, {{"y", 2 * x}});
  const std::string text = c_function(program, "f");
  EXPECT_THAT(text, testing::HasSubstr("void f(const double *restrict x, double *restrict y)"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("*/ evil")));
  EXPECT_THROW(c_function(program, "1f"), std::invalid_argument);
  EXPECT_THROW(c_function(program, "f()"), std::invalid_argument);
}

TEST(Forms, AreInterpretedWhereExecutableMemoryIsRefused) {
  const Case c = make_case(23);
  rlimit before;
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit none = before;
  none.rlim_cur = 0;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);  // no file for the code
  const Code code(c.program, 4);
  const std::string reason = machine_code_refused();
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_FALSE(code.is_machine_code());
  EXPECT_NE(reason, "");
  expect_same_bits(outputs(code, c.bodies), c.expected, "refused");
}

TEST(Forms, AreSharedByThreads) {
  const Case c = make_case(39);
  const Code code(c.program, 8);
  std::vector<Bodies> found(8);
  std::vector<std::thread> threads;
  for (size_t i = 0; i < found.size(); ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 50; ++k) found[i] = outputs(code, c.bodies, i % 4);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Bodies& y : found) expect_same_bits(y, c.expected, "a thread");
}

TEST(Forms, OfAnEmptyProgramDoNothing) {
  const auto program = std::make_shared<const Program>(Recording(), Program::Outputs{});
  for (const Machine machine : {Machine::allowed, Machine::refused}) {
    const Code code(program, 8, machine);
    code(nullptr, nullptr, std::vector<double>(code.work_size() + 1).data());
  }
}

}  // namespace
}  // namespace hamel::graph
