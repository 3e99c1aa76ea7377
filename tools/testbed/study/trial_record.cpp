#include "tools/testbed/study/trial_record.h"

#include "tools/testbed/hash.h"

namespace polnav::testbed {
namespace {

Json ToJson(const TrialScore& score) {
  Json metrics = Json::object();
  for (const auto& [path, value] : score.metrics) metrics[path] = value;
  return {{"estimator", score.estimator},
          {"sha256", score.sha256},
          {"metrics", metrics},
          {"heading_deg", score.series.heading_deg},
          {"position_m", score.series.position_m}};
}

// A float that is not a number is written as null by dump(), and kept by CBOR.
Json ToJson(const TrialRecord& record) {
  Json inputs = Json::array();
  for (const InputValue& value : record.inputs) {
    inputs.push_back({value.key, value.text});
  }
  Json scores = Json::array();
  for (const TrialScore& score : record.scores) scores.push_back(ToJson(score));
  return {{"trial", record.trial},
          {"case", record.case_id},
          {"sample", record.sample},
          {"inputs", inputs},
          {"outcome", NameOf(record.outcome)},
          {"streams_sha256", record.streams_sha256},
          {"scores", scores}};
}

TrialScore ScoreFrom(const Json& json) {
  TrialScore score{
      .estimator = json["estimator"], .sha256 = json["sha256"], .metrics = {}, .series = {}};
  for (const auto& [path, value] : json["metrics"].items()) {
    score.metrics.emplace_back(path, value.get<double>());
  }
  score.series.heading_deg = json["heading_deg"].get<std::vector<float>>();
  score.series.position_m = json["position_m"].get<std::vector<float>>();
  return score;
}

}  // namespace

std::string ToCbor(const TrialRecord& record) {
  Json json = ToJson(record);
  json["detail"] = record.detail;
  json["wall_s"] = record.wall_s;
  json["peak_rss_mb"] = record.peak_rss_mb;
  std::string bytes;
  Json::to_cbor(json, bytes);
  return bytes;
}

TrialRecord FromCbor(const std::string& bytes) {
  const Json json = Json::from_cbor(bytes);
  TrialRecord record;
  record.trial = json["trial"];
  record.case_id = json["case"];
  record.sample = json["sample"];
  for (const Json& input : json["inputs"]) record.inputs.push_back(TextInput(input[0], input[1]));
  record.outcome = ParseOutcome(json["outcome"].get<std::string>()).value();
  record.detail = json["detail"];
  record.streams_sha256 = json["streams_sha256"];
  for (const Json& score : json["scores"]) record.scores.push_back(ScoreFrom(score));
  record.wall_s = json["wall_s"];
  record.peak_rss_mb = json["peak_rss_mb"];
  return record;
}

std::string RecordSha256(const TrialRecord& record) { return Sha256Of(ToJson(record).dump()); }

}  // namespace polnav::testbed
