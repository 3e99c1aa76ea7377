// A scenario file that Polnav does not understand is refused, and the message says where, why and
// what would have been right.
#include "tools/testbed/option_loader.h"

#include <gtest/gtest.h>

#include "tools/testbed/input_error.h"
#include "tools/testbed/option_tree.h"

namespace polnav::testbed {
namespace {

struct Lens {
  double focal_mm = 8.0;
  template <typename Visitor>
  void Visit(Visitor& v) {
    v("focal_mm", focal_mm, {.min = 1.0, .max = 100.0});
  }
};

struct Camera {
  double rate_hz = 10.0;
  int width_px = 640;
  bool rolling = false;
  std::string label = "left";
  std::string shutter = "global";
  Eigen::Vector3d position_m = {0.0, 0.1, 1.5};
  std::uint64_t seed = 7;
  std::optional<double> gain;
  std::optional<Lens> lens;
  std::vector<Lens> spares;
  std::vector<std::string> tags;
  Lens fixed;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("rate_hz", rate_hz, {.min = 0.1, .max = 500.0});
    v("width_px", width_px, {.min = 16, .max = 4096});
    v("rolling", rolling);
    v("label", label);
    v("shutter", shutter, {"global", "rolling"});
    v("position_m", position_m, {.min = -10.0, .max = 10.0});
    v("seed", seed);
    v("gain", gain, {.min = 0.0});
    v("lens", lens);
    v("spares", spares);
    v("tags", tags);
    v("fixed", fixed);
  }
};

Camera Load(const std::string& text, const std::vector<std::string>& set = {}) {
  YamlDocument document = ParseYaml(text, "cam.yaml");
  for (const std::string& s : set) ApplyOverride(document, s, "--set " + s);
  Camera camera;
  LoadOptions(document, camera);
  return camera;
}

std::string ErrorOf(const std::string& text, const std::vector<std::string>& set = {}) {
  try {
    Load(text, set);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(OptionLoader, KeepsDefaultsOfKeysThatAreAbsent) {
  const Camera camera = Load("rate_hz: 25\n");
  EXPECT_EQ(camera.rate_hz, 25.0);
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_FALSE(camera.lens.has_value());
}

TEST(OptionLoader, ReadsEveryType) {
  const Camera camera = Load(
      "rate_hz: 1.5e1\nwidth_px: 320\nrolling: true\nlabel: \"007\"\nshutter: rolling\n"
      "position_m: [1, -2, 3.5]\nseed: 18446744073709551615\ngain: 2\nlens: {focal_mm: 12}\n"
      "spares: [{focal_mm: 4}, {}]\ntags: one\nfixed:\n");
  EXPECT_EQ(camera.rate_hz, 15.0);
  EXPECT_EQ(camera.width_px, 320);
  EXPECT_TRUE(camera.rolling);
  EXPECT_EQ(camera.label, "007");
  EXPECT_EQ(camera.shutter, "rolling");
  EXPECT_EQ(camera.position_m, Eigen::Vector3d(1.0, -2.0, 3.5));
  EXPECT_EQ(camera.seed, 18446744073709551615ULL);
  EXPECT_EQ(camera.gain, 2.0);
  ASSERT_TRUE(camera.lens.has_value());
  EXPECT_EQ(camera.lens->focal_mm, 12.0);
  ASSERT_EQ(camera.spares.size(), 2U);
  EXPECT_EQ(camera.spares[1].focal_mm, 8.0);
  EXPECT_EQ(camera.tags, std::vector<std::string>{"one"});
}

TEST(OptionLoader, RefusesAnUnknownKeyAndNamesTheNearest) {
  EXPECT_EQ(ErrorOf("width_px: 64\nrate_hy: 5\n"),
            "cam.yaml:2: rate_hy: unknown key; did you mean 'rate_hz'?");
  EXPECT_EQ(ErrorOf("rate: 5\n"), "cam.yaml:1: rate: unknown key; did you mean 'rate_hz'?");
  EXPECT_EQ(ErrorOf("lens:\n  focl_mm: 5\n"),
            "cam.yaml:2: lens.focl_mm: unknown key; did you mean 'focal_mm'?");
  EXPECT_EQ(ErrorOf("spares:\n  - focal_mm: 5\n  - zzzzzzzz: 1\n"),
            "cam.yaml:3: spares.1.zzzzzzzz: unknown key; valid here: focal_mm");
}

TEST(OptionLoader, RefusesANumberOutOfRangeAndPrintsTheRange) {
  EXPECT_EQ(ErrorOf("rate_hz: 900\n"), "cam.yaml:1: rate_hz: 900 is out of range, [0.1, 500]");
  EXPECT_EQ(ErrorOf("width_px: 2\n"), "cam.yaml:1: width_px: 2 is out of range, [16, 4096]");
  EXPECT_EQ(ErrorOf("gain: -1\n"), "cam.yaml:1: gain: -1 is out of range, at least 0");
  EXPECT_EQ(ErrorOf("position_m: [0, 11, 0]\n"),
            "cam.yaml:1: position_m: 11 is out of range, [-10, 10]");
}

TEST(OptionLoader, RefusesAWrongType) {
  EXPECT_EQ(ErrorOf("rate_hz: fast\n"), "cam.yaml:1: rate_hz: expected a number, got 'fast'");
  EXPECT_EQ(ErrorOf("rate_hz: \"5\"\n"),
            "cam.yaml:1: rate_hz: expected a number, got '5' in quotes");
  EXPECT_EQ(ErrorOf("rate_hz:\n"), "cam.yaml:1: rate_hz: expected a number, got nothing");
  EXPECT_EQ(ErrorOf("rate_hz: [1]\n"), "cam.yaml:1: rate_hz: expected a number, got a list");
  EXPECT_EQ(ErrorOf("rate_hz: .nan\n"), "cam.yaml:1: rate_hz: expected a number, got '.nan'");
  EXPECT_EQ(ErrorOf("rate_hz: inf\n"), "cam.yaml:1: rate_hz: expected a number, got 'inf'");
  EXPECT_EQ(ErrorOf("width_px: 64.5\n"),
            "cam.yaml:1: width_px: expected a whole number, got '64.5'");
  EXPECT_EQ(ErrorOf("seed: -1\n"),
            "cam.yaml:1: seed: expected a whole number from 0 to 2^64 - 1, got '-1'");
  EXPECT_EQ(ErrorOf("rolling: 1\n"), "cam.yaml:1: rolling: expected true or false, got '1'");
  EXPECT_EQ(ErrorOf("label: {a: 1}\n"), "cam.yaml:1: label: expected text, got a section");
  EXPECT_EQ(ErrorOf("lens: 5\n"), "cam.yaml:1: lens: expected a section (key: value), got '5'");
  EXPECT_EQ(ErrorOf("spares: {a: 1}\n"), "cam.yaml:1: spares: expected a list, got a section");
  EXPECT_EQ(ErrorOf("position_m: [1, 2]\n"),
            "cam.yaml:1: position_m: expected a list of 3 numbers, got 2 items");
  EXPECT_EQ(ErrorOf("position_m: [1, b, 2]\n"),
            "cam.yaml:1: position_m: expected a list of 3 numbers, got 'b' in it");
  EXPECT_EQ(ErrorOf("- 1\n"), "cam.yaml: expected a section (key: value), got a list");
}

TEST(OptionLoader, RefusesAChoiceThatIsNotInTheList) {
  EXPECT_EQ(ErrorOf("shutter: globl\n"),
            "cam.yaml:1: shutter: 'globl' is not one of: global, rolling; did you mean 'global'?");
}

TEST(OptionLoader, RefusesTheSameKeyTwice) {
  EXPECT_EQ(ErrorOf("rate_hz: 5\nrate_hz: 6\n"), "cam.yaml:2: rate_hz: this key is given twice");
  EXPECT_EQ(ErrorOf("lens:\n  focal_mm: 5\n  focal_mm: 5\n"),
            "cam.yaml:3: lens.focal_mm: this key is given twice");
}

TEST(OptionLoader, RefusesWhatIsNoYaml) {
  EXPECT_EQ(ErrorOf("rate_hz: 5\nlens: {focal_mm: 3\nwidth_px: 5\n").substr(0, 9), "cam.yaml:");
  EXPECT_NE(ErrorOf("a: [1, 2\n").find("not YAML"), std::string::npos);
  EXPECT_EQ(ErrorOf(""), "cam.yaml: is empty");
  EXPECT_EQ(ErrorOf("a: 1\n---\nb: 2\n"), "cam.yaml: holds more than one YAML document");
}

TEST(OptionLoader, RefusesAnAliasThatContainsItself) {
  EXPECT_NE(ErrorOf("tags: &a [*a]\n"), "no error");
}

TEST(OptionLoader, RefusesAFileThatIsNotThere) {
  try {
    (void)ReadYaml("/nowhere/at/all.yaml");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/nowhere/at/all.yaml: no such file");
  }
  EXPECT_THROW((void)ReadYaml("/"), InputError);
}

TEST(Override, ChangesAddsAndRemoves) {
  const std::string text = "rate_hz: 5\nlens: {focal_mm: 20}\nspares: [{}, {}]\n";
  EXPECT_EQ(Load(text, {"rate_hz=7"}).rate_hz, 7.0);
  EXPECT_EQ(Load(text, {"lens.focal_mm=9"}).lens->focal_mm, 9.0);
  EXPECT_FALSE(Load(text, {"lens=null"}).lens.has_value());
  EXPECT_EQ(Load("rate_hz: 5\n", {"lens.focal_mm=9"}).lens->focal_mm, 9.0);
  EXPECT_EQ(Load(text, {"spares.1.focal_mm=3"}).spares[1].focal_mm, 3.0);
  EXPECT_EQ(Load(text, {"position_m=[1, 2, 3]"}).position_m.y(), 2.0);
  EXPECT_EQ(Load(text, {"rate_hz=7", "rate_hz=8"}).rate_hz, 8.0);
}

TEST(Override, IsNamedWhenItIsWrong) {
  const std::string text = "rate_hz: 5\nspares: [{}]\n";
  EXPECT_EQ(ErrorOf(text, {"rate_hz=900"}),
            "--set rate_hz=900: rate_hz: 900 is out of range, [0.1, 500]");
  EXPECT_EQ(ErrorOf(text, {"rate_zz=9"}),
            "--set rate_zz=9: rate_zz: unknown key; did you mean 'rate_hz'?");
  EXPECT_EQ(ErrorOf(text, {"rate_hz"}), "--set rate_hz: expected key.path=value");
  EXPECT_EQ(ErrorOf(text, {"rate_hz="}), "--set rate_hz=: the value is missing");
  EXPECT_EQ(ErrorOf(text, {"lens..focal_mm=2"}), "--set lens..focal_mm=2: expected key.path=value");
  EXPECT_EQ(ErrorOf(text, {"rate_hz.x=1"}),
            "--set rate_hz.x=1: 'x' is below a plain value, not in a section");
  EXPECT_EQ(ErrorOf(text, {"spares.1.focal_mm=3"}),
            "--set spares.1.focal_mm=3: '1' is not one of the list's 1 items (counted from 0)");
}

TEST(OptionTree, ReadsBackTheSameValues) {
  Camera camera =
      Load("rate_hz: 0.1\nlabel: \"7\"\nlens: {}\nspares: [{focal_mm: 4}]\ngain: 0.3\n");
  camera.rate_hz = 0.1 + 0.2;  // needs all 17 digits
  const std::string yaml = ToYaml(OptionValues(camera));
  const Camera again = Load(yaml);
  EXPECT_EQ(again.rate_hz, camera.rate_hz);
  EXPECT_EQ(ToYaml(OptionValues(again)), yaml);
}

TEST(OptionTree, SchemaAdmitsWhatTheLoaderAdmits) {
  const Json schema = OptionSchema<Camera>();
  EXPECT_EQ(schema["additionalProperties"], false);
  const Json& p = schema["properties"];
  EXPECT_EQ(p["rate_hz"]["maximum"], 500.0);
  EXPECT_EQ(p["rate_hz"]["default"], 10.0);
  EXPECT_EQ(p["shutter"]["enum"], Json({"global", "rolling"}));
  EXPECT_EQ(p["lens"]["type"], Json({"object", "null"}));
  EXPECT_EQ(p["lens"]["properties"]["focal_mm"]["minimum"], 1.0);
  EXPECT_EQ(p["spares"]["items"]["properties"]["focal_mm"]["type"], "number");
  EXPECT_EQ(p["position_m"]["minItems"], 3);
}

TEST(EditDistance, CountsASwapOfNeighboursOnce) {
  EXPECT_EQ(EditDistance("rate", "rate"), 0);
  EXPECT_EQ(EditDistance("", "abc"), 3);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3);
  EXPECT_EQ(EditDistance("rtae", "rate"), 1);
}

}  // namespace
}  // namespace polnav::testbed
