// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics in reports: the names that other programs read, tables for people and for spreadsheets.
#include "engine/reports/metrics_report.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

const std::vector<MetricValue>& metrics() {
  static const std::vector<MetricValue> all{
      {"path", "Path, all of it", "Cotin", left_hand, true, 12.3456, "mm", 1, Better::low},
      {"path", "Path, all of it", "Cotin", right_hand, false, 0, "mm", 1, Better::low},
      {"presses", "Presses", "Insula", left_hand, true, 0, "", 0, Better::none},
      {"presses", "Presses", "Insula", right_hand, true, 0, "", 0, Better::none},
      {"balance", "<Balance>", "Insula", both_hands, true, -0.001, "", 2, Better::high}};
  return all;
}

TEST(MetricsJson, HasTheNamesThatProgramsRead) {
  const auto json = metrics_json(metrics());
  ASSERT_EQ(json.size(), 5u);
  EXPECT_EQ(json[0].at("id"), "path");
  EXPECT_EQ(json[0].at("hand"), "left");
  EXPECT_EQ(json[0].at("unit"), "mm");
  EXPECT_EQ(json[0].at("value"), 12.3456);
  EXPECT_EQ(json[0].at("better"), "low");
  EXPECT_EQ(json[0].at("source"), "Cotin");
  EXPECT_TRUE(json[1].at("value").is_null()) << "not known";
  EXPECT_EQ(json[4].at("hand"), "both");
  EXPECT_EQ(json[4].at("better"), "high");
  EXPECT_FALSE(metrics_json(metrics(), false)[0].contains("source"));
}

TEST(MetricsHtml, ShowsWhatSaysSomething) {
  const std::string html = metrics_html(metrics());
  EXPECT_NE(html.find("<td>Path, all of it</td><td class=\"n\">12.3 mm</td><td class=\"n\"></td><td>less</td>"),
            std::string::npos)
      << html;
  EXPECT_EQ(html.find("Presses"), std::string::npos) << "nobody pressed";
  EXPECT_NE(html.find("<td>&lt;Balance&gt;</td><td class=\"n\" colspan=\"2\">0.00</td><td>more</td>"),
            std::string::npos)
      << html;
  EXPECT_EQ(metrics_html({}), "");
}

TEST(MetricsCsv, QuotesWhatNeedsIt) {
  const std::string csv = metrics_csv(metrics());
  EXPECT_EQ(csv.substr(0, csv.find("\npresses")),
            "id,hand,value,unit,better,text\n"
            "path,left,12.3456,mm,low,\"Path, all of it\"\n"
            "path,right,,mm,low,\"Path, all of it\"");
}

}  // namespace
}  // namespace insula
