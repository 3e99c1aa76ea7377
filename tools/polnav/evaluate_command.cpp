#include <fmt/format.h>

#include <vector>

#include "tools/polnav/commands.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/metrics.h"
#include "tools/testbed/score.h"
#include "tools/testbed/tum.h"

namespace polnav::testbed {
namespace {

Alignment AlignmentOf(const std::string& name) {
  if (name == "yaw") return Alignment::kYaw;
  return name == "se3" ? Alignment::kSe3 : Alignment::kNone;
}

std::vector<double> Degrees(std::vector<double> angles) {
  for (double& angle : angles) angle = nav::RadToDeg(angle);
  return angles;
}

Json RpeJson(const std::vector<PosePair>& pairs, double delta_m) {
  const std::optional<RpeScore> rpe = ScoreRpe(pairs, delta_m);
  if (!rpe) return nullptr;
  return {{"trans_m", ToJson(rpe->trans_m)}, {"rot_deg", ToJson(rpe->rot_deg)}};
}

Json Compare(const std::vector<PosePair>& pairs) {
  std::vector<double> heading_deg;
  for (const PosePair& pair : pairs) {
    heading_deg.push_back(nav::RadToDeg(
        nav::WrapPi(nav::CompassHeading(pair.estimate.q) - nav::CompassHeading(pair.truth.q))));
  }
  Json json;
  json["ate_m"] = ToJson(Summarize(ApeTranslation(pairs)));
  json["ape_rot_deg"] = ToJson(Summarize(Degrees(ApeAngle(pairs))));
  json["rpe_1m"] = RpeJson(pairs, 1.0);
  json["rpe_20m"] = RpeJson(pairs, 20.0);
  json["rpe_100m"] = RpeJson(pairs, 100.0);
  json["heading_deg"] = ToJson(ScoreHeading(heading_deg));
  return json;
}

std::vector<std::string> Row(const std::string& title, const Json& errors) {
  std::vector<std::string> row{title};
  for (const char* name : {"rmse", "mean", "median", "std", "min", "max", "sse"}) {
    const std::optional<double> value =
        errors.is_object() ? MetricAt(errors, name) : std::optional<double>();
    row.push_back(value ? fmt::format("{:.6f}", *value) : "-");
  }
  return row;
}

std::string Tables(const Json& json) {
  TextTable errors({"", "rmse", "mean", "median", "std", "min", "max", "sse"});
  errors.Add(Row("ATE [m]", json["ate_m"]));
  errors.Add(Row("APE rotation [deg]", json["ape_rot_deg"]));
  for (const auto& [key, title] :
       {std::pair{"rpe_1m", "RPE 1 m"}, {"rpe_20m", "RPE 20 m"}, {"rpe_100m", "RPE 100 m"}}) {
    const Json& rpe = json[key];
    errors.Add(Row(fmt::format("{} [m]", title), rpe.is_null() ? rpe : rpe["trans_m"]));
    errors.Add(Row(fmt::format("{} [deg]", title), rpe.is_null() ? rpe : rpe["rot_deg"]));
  }
  TextTable heading({"", "mean_abs", "mean", "rmse", "std", "max"});
  std::vector<std::string> row{"heading [deg]"};
  for (const auto& item : json["heading_deg"])
    row.push_back(fmt::format("{:.6f}", item.get<double>()));
  heading.Add(row);
  return errors.Text() + "\n" + heading.Text();
}

}  // namespace

int Evaluate(const EvaluateArguments& arguments, const Console& console) {
  const Trajectory truth = ReadTum(arguments.truth);
  const Trajectory estimate = ReadTum(arguments.estimate);
  std::vector<PosePair> pairs = Associate(truth, estimate);
  if (pairs.empty()) {
    throw InputError(arguments.estimate, 0, "",
                     fmt::format("no time is within 0.01 s of one in {}", arguments.truth));
  }
  const std::optional<nav::Pose> T_WE = Align(pairs, AlignmentOf(arguments.align));
  if (!T_WE) {
    throw InputError(
        arguments.estimate, 0, "",
        fmt::format("--align {}: the positions do not determine the alignment", arguments.align));
  }
  pairs = Moved(*T_WE, std::move(pairs));
  Json json = {{"truth", arguments.truth},
               {"estimate", arguments.estimate},
               {"align", arguments.align},
               {"pairs", pairs.size()}};
  json.update(Compare(pairs));
  if (arguments.json) {
    console.out << json.dump(2) << "\n";
  } else {
    console.out << fmt::format("{} against {}: {} pairs, alignment: {}\n\n", arguments.estimate,
                               arguments.truth, pairs.size(), arguments.align)
                << Tables(json);
  }
  return kExitHolds;
}

}  // namespace polnav::testbed
