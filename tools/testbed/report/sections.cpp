#include "tools/testbed/report/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "sky/sun.h"
#include "tools/testbed/metrics.h"

namespace polnav::testbed {
namespace {

std::string Base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t block = 0;
    for (std::size_t j = 0; j < 3; ++j) block = (block << 8U) | (j < n ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= n ? kAlphabet[(block >> (18U - 6U * j)) & 63U] : '=';
    }
  }
  return text;
}

std::string Figure(const std::string& value, const std::string& label) {
  return fmt::format("<div class=\"figure\"><b>{}</b><span>{}</span></div>", EscapeMarkup(value),
                     EscapeMarkup(label));
}

std::string SunText(const sky::SiteOptions& site) {
  const std::optional<sky::UtcDate> utc = sky::ParseUtc(site.utc);
  if (!utc) return "–";
  const sky::SunPosition sun = sky::ComputeSun(sky::SiteOf(site), *utc);
  return fmt::format("{:.1f}° / {:.1f}°", nav::RadToDeg(sun.azimuth_rad),
                     nav::RadToDeg(sun.elevation_rad));
}

// With a space, where a narrow card may break the line.
std::string StartText(std::string utc) {
  std::replace(utc.begin(), utc.end(), 'T', ' ');
  return utc;
}

// "probability 0.5, hold_s 0.2": what is not zero.
std::string SettingText(const Json& settings) {
  std::string text;
  for (const auto& [key, value] : settings.items()) {
    const bool zero = value == Json(0.0) || value == Json({0.0, 0.0, 0.0});
    const bool all = value == Json("both") || (key == "channel" && value == Json(-1));
    if (zero || all) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value.dump());
  }
  return text;
}

std::string Text(const Json& result, const std::string& path, const char* format) {
  const std::optional<double> value = MetricAt(result, path);
  return value ? fmt::format(fmt::runtime(format), *value) : "–";
}

}  // namespace

std::string HtmlTable::Html() const {
  std::string html = "<div class=\"scroll\"><table>";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const char* tag = r == 0 ? "th" : "td";
    if (r == 0) html += "<thead>";
    if (r == 1) html += "<tbody>";
    const bool has_class = r > 0 && r - 1 < row_class.size() && !row_class[r - 1].empty();
    html += has_class ? fmt::format("<tr class=\"{}\">", row_class[r - 1]) : "<tr>";
    for (const std::string& cell : rows[r]) {
      html += fmt::format("<{0}{1}>{2}</{0}>", tag, text_columns ? " class=\"text\"" : "",
                          EscapeMarkup(cell));
    }
    html += "</tr>";
    if (r == 0) html += "</thead>";
  }
  return html + (rows.size() > 1 ? "</tbody></table></div>" : "</table></div>");
}

std::string ChartCard(const std::string& id, const std::string& title, const std::string& note,
                      const std::string& shape) {
  return fmt::format(
      "<section><h2>{}</h2><div class=\"{}\"><canvas id=\"{}\"></canvas></div>"
      "<p class=\"soft small\">{}</p></section>",
      title, shape, id, note);
}

std::string HeaderSection(const ReportInput& input) {
  const Scenario& s = input.scenario;
  std::string verdict;
  if (!input.criteria.empty()) {
    const bool passed = AllPassed(input.criteria);
    verdict = fmt::format("<div class=\"verdict {}\">{}</div>", passed ? "pass" : "fail",
                          passed ? "all criteria hold" : "a criterion failed");
    verdict.replace(verdict.find("<div"), 4, "<div style=\"flex:0 0 auto\"");
  }
  const Json& result = input.result;
  return fmt::format("<header><div><h1>{}</h1><p class=\"soft\">{}</p></div>{}</header>",
                     EscapeMarkup(s.name), EscapeMarkup(s.description), verdict) +
         "<div class=\"figures\">" +
         Figure(Text(result, "sim_duration_s", "{:.1f} s"),
                result["level"] == kReplayLevel ? "replayed" : "simulated") +
         Figure(Text(result, "real_time_factor", "{:.2f} ×"), "real time") +
         Figure(Text(result, "peak_rss_mb", "{:.0f} MB"), "peak memory") +
         Figure(std::to_string(input.scenario.seed), "seed") +
         Figure(SunText(s.site), "sun azimuth / elevation") +
         Figure(StartText(s.site.utc), "start") + "</div>";
}

bool HasPositions(const ReportInput& input) {
  return std::any_of(input.record.estimators.begin(), input.record.estimators.end(),
                     [](const EstimatorRun& run) { return !run.heading_only; });
}

std::string ChartSections(const ReportInput& input) {
  const std::string heading = ChartCard(
      "heading", "Heading error over time",
      "Estimate minus truth; shaded: three sigma as the estimator claims." +
          std::string(input.scenario.disturbances.empty() ? "" : " Purple stretches: disturbed."));
  std::string html;
  if (input.record.estimators.empty() || HasPositions(input)) {
    const std::string alignment = AlignmentText(input.record);
    html = "<div class=\"columns\">" + ChartCard("trajectory", "Trajectory",
                                                 "Seen from above, equal axes, " + alignment + ".",
                                                 "chart square");
    if (input.record.estimators.empty() || input.record.truth.empty()) return html + "</div>";
    html +=
        "<div>" + heading +
        ChartCard("position", "Position error over time", "Three-dimensional, " + alignment + ".") +
        "</div></div>";
  } else {
    html = heading;
  }
  html += "<div class=\"columns\">";
  if (!input.record.polarization_readings.empty()) {
    html += ChartCard("readings", "Single polarization readings",
                      "The heading that one sample alone would give, against the truth.");
  }
  if (input.record.force) {
    html +=
        ChartCard("force", "Spectrum of the accelerometers",
                  "Amplitude of the specific force by frequency, mean over stretches of some ten "
                  "seconds. Dashed, where the vehicle walks: the rate of its steps.");
  }
  if (!input.record.rss_mb.empty()) {
    html += ChartCard("memory", "Memory", "Of the whole process.");
  }
  return html + "</div>";
}

std::string FaultSection(const ReportInput& input) {
  if (input.scenario.faults.empty()) return "";
  HtmlTable table{.rows = {{"sensor", "fault", "from [s]", "to [s]", "with"}},
                  .text_columns = true};
  for (const sim::FaultOptions& fault : input.scenario.faults) {
    const char* kind = sim::NameOf(sim::KindsGiven(fault).at(0));
    table.rows.push_back(
        {fault.sensor, kind, fmt::format("{:g}", fault.start_s),
         fault.duration_s ? fmt::format("{:g}", fault.start_s + *fault.duration_s) : "the end",
         SettingText(OptionValues(fault)[kind])});
  }
  return "<section><h2>Faults</h2>" + table.Html() +
         "<p class=\"soft small\">Shaded grey in the charts over time.</p></section>";
}

std::string PictureSection(const ReportInput& input) {
  if (input.record.images.empty()) return "";
  std::string html = "<section><h2>What the sensors saw</h2><div class=\"pictures\">";
  for (const SampleImage& sample : input.record.images) {
    std::vector<unsigned char> png;
    if (sample.image.empty() || !cv::imencode(".png", sample.image, png)) {
      throw std::logic_error("sample image '" + sample.title + "' cannot be encoded");
    }
    html += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\">"
        "<figcaption>{0}, {2:.2f} s</figcaption></figure>",
        EscapeMarkup(sample.title), Base64(png), nav::ToSeconds(sample.stamp));
  }
  return html + "</div></section>";
}

std::string TimingAndStreamSections(const ReportInput& input) {
  HtmlTable timing{.rows = {{"stage", "calls", "median [ms]", "99 % [ms]"}}};
  for (const auto& [stage, times] : input.result["timing_ms"].items()) {
    timing.rows.push_back({stage, std::to_string(input.record.timing.at(stage).ms.size()),
                           Text(times, "median", "{:.3f}"), Text(times, "p99", "{:.3f}")});
  }
  HtmlTable streams{.rows = {{"stream", "count", "SHA-256"}}};
  for (const auto& [name, stream] : input.result["streams"].items()) {
    streams.rows.push_back({name, stream["count"].dump(), stream["sha256"].get<std::string>()});
  }
  for (const auto& [name, scores] : input.result["estimators"].items()) {
    streams.rows.push_back({"estimates: " + name, "", scores["sha256"].get<std::string>()});
  }
  std::string html;
  if (timing.rows.size() > 1)
    html += "<section><h2>Time a stage</h2>" + timing.Html() + "</section>";
  if (streams.rows.size() > 1) {
    html += "<section><h2>Streams</h2>" + streams.Html() +
            "<p class=\"soft small\">The same scenario and seed give the same hashes, whatever the "
            "number of threads.</p></section>";
  }
  return html;
}

std::string AgainSection(const ReportInput& input) {
  return "<section><h2>Run it again</h2><p><code>" + EscapeMarkup(input.command_line) +
         "</code></p><p class=\"soft small\">" + EscapeMarkup(VersionText()) +
         "<br>scenario SHA-256 <code>" + input.result["scenario_sha256"].get<std::string>() +
         "</code></p><details><summary>Scenario, defaults included</summary><pre>" +
         EscapeMarkup(ResolvedYaml(input.scenario)) + "</pre></details></section>";
}

}  // namespace polnav::testbed
