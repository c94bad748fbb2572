// Rows of a mechanism that repeat or contradict others: what is dropped and what is refused.
#include "mechanism_texts.hpp"

namespace {

using namespace hamel::test;
using testing::HasSubstr;

using MechanismRows = MechanismMistakes;

/// Blades on arms to both sides are equivalent as drawn, but not elsewhere.
TEST_F(MechanismRows, ThatRepeatOthersAtTheStart) {
  std::string walker = kFlat;
  for (const std::string side : {"1", "-1"})
    walker += "[[body]]\nname = \"arm" + side + "\"\nmass = 1\nat = [0, " + side +
              ", 0]\ninertia = [1, 1, 1]\n[[joint]]\nkind = \"hinge\"\nparent = \"a\"\n" +
              "child = \"arm" + side + "\"\n[[blade]]\nbody = \"arm" + side + "\"\nat = [0, " +
              side + ", 0]\n";
  refuses({{walker,
            "30:1: blade 'arm-1' (does not slip across its edge) is implied by blade 'arm1' "
            "(does not slip across its edge) at the start; start elsewhere"}});
  EXPECT_EQ(run({"run", write(walker + "[start]\narm1.angle = 0.3\n"), "--until", "0.1"}).status,
            0);
}

/// Dropped is what agrees: three wheels on one axle, a prescribed one beside two, on ground that
/// moves.
TEST_F(MechanismRows, ThatContradictOthers) {
  std::string cart = "redundant = \"drop\"\n" + kFlat + "at = [0, 0, 0]\n";
  for (const std::string side : {"0.3", "-0.3", "0"})
    cart += "[[body]]\nname = \"w" + side + "\"\nmass = 1\nat = [0, " + side +
            ", 0.1]\ncylinder = [0.1, 0.03]\naxis = [0, 1, 0]\n[[joint]]\nkind = \"hinge\"\n" +
            "parent = \"a\"\nchild = \"w" + side + "\"\nat = [0, " + side +
            ", 0.1]\naxis = [0, 1, 0]\n[[wheel]]\nbody = \"w" + side + "\"\nat = [0, " + side +
            ", 0.1]\nradius = 0.1\n";
  cart +=
      "[[body]]\nname = \"fan\"\nmass = 1\nsphere = 1\n[[joint]]\nkind = \"hinge\"\n"
      "parent = \"a\"\nchild = \"fan\"\n";
  const auto prescribed = [&](const std::string& left, const std::string& right,
                              const std::string& middle) {
    return cart + "[[prescribed]]\njoint = \"w0.3\"\n" + left +
           "\n[[prescribed]]\njoint = \"w-0.3\"\n" + right + "\n[[prescribed]]\njoint = \"w0\"\n" +
           middle + "\n";
  };
  const std::string two = "rate = 2", wrong = "prescribed 'w0' (moves as prescribed) contradicts ";
  const std::string of_time = "rate = \"2*t\"", later = "rate = \"t < 500 ? 2 : 5\"";
  for (const std::string& rate : {two, of_time}) {
    const Outcome o = run({"run", write(prescribed(rate, rate, rate)), "--until", "0.1"});
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_THAT(o.out,
                HasSubstr("row dropped: prescribed 'w0' (moves as prescribed) is implied by "));
  }
  refuses({
      {prescribed(two, two, "rate = 5"), "73:1: " + wrong},
      {prescribed(two, two, of_time), "73:1: " + wrong},
      {prescribed("rate = \"2*t\"", of_time, "rate = \"2*t + max(0, t - 10)\""), "73:1: " + wrong},
      {prescribed(two, two, ""), "70:1: prescribed 'w-0.3' (moves as prescribed) contradicts "},
      {prescribed("", "", two), "73:1: " + wrong},
  });
  const auto driven = [&](const std::string& value) {
    return run(
        {"run", write(prescribed(two, two, "")), "--input", "w0.rate=" + value, "--until", "0.1"});
  };
  const std::string told = write("rate.csv", "t,value\n0,2\n0.05,2\n0.1,3\n");
  EXPECT_EQ(driven("2").status, 0);
  EXPECT_THAT(driven("5").err, HasSubstr(" at t = 0: w-0.3.rate has to be "));
  EXPECT_THAT(driven(told).err, HasSubstr("failed in step "));
  EXPECT_THAT(driven(told).err, HasSubstr("rows contradict each other at t = 0.1: "));
  const std::string jumps = write(prescribed(two, two, later));
  EXPECT_EQ(run({"run", jumps, "--until", "0.1"}).status, 0);
  EXPECT_THAT(run({"run", jumps, "--from", "600", "--until", "601"}).err,
              HasSubstr("system.toml:73:1: " + wrong));
  const std::string blade =
      "redundant = \"drop\"\n[[body]]\nname = \"a\"\nmass = 1\nat = [1, 0, 0]\nsphere = 1\n"
      "[[joint]]\nkind = \"hinge\"\nchild = \"a\"\n[[blade]]\nname = \"keel\"\nbody = \"a\"\n";
  EXPECT_EQ(run({"run", write(blade), "--velocity", "1", "--until", "0.1"}).status, 0);
  refuses({{blade + "[ground]\nvelocity = [0, 1, 0]\n",
            "10:1: blade 'keel' (does not slip across its edge) contradicts the joints: its body "
            "cannot move with the ground; leave it out"}});
}

}  // namespace
