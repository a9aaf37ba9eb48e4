// SPDX-License-Identifier: GPL-3.0-or-later
// Scripts of charts, and pages.
#include "msml/study/chart.hpp"

#include <gmock/gmock.h>

#include "msml/core/error.hpp"
#include "msml/study/map.hpp"
#include "msml/study/page.hpp"
#include "tests/compile/scenes.hpp"

namespace msml {
namespace {

using testing::HasSubstr;
using testing::Not;

Table convergence() {
  return {{"kind", "n", "status", "unknowns", "error", "time", "time_low", "time_high", "reason", "key"},
          {{"tet4", "1", "done", "100", "0.4", "0.01", "0.008", "0.02", "", "k"},
           {"tet4", "2", "done", "800", "0.1", "0.1", "0.09", "0.12", "", "k"},
           {"tet4", "4", "done", "6400", "0.025", "1", "0.9", "1.2", "", "k"},
           {"tet10", "1", "done", "800", "0.08", "0.2", "0.1", "0.3", "", "k"},
           {"tet10", "2", "done", "6400", "0.005", "2", "1.9", "2.1", "", "k"},
           {"tet10", "4", "not converged", "51200", "", "", "", "", "it stalled", "k"}}};
}

Study study() {
  Study study{.id = "s", .title = "Elements", .vary = {}, .truth = {}, .measures = {}, .charts = {}, .where = {}};
  study.vary.push_back({.variables = {"kind"}, .values = {}, .where = {}});
  study.vary.push_back({.variables = {"n"}, .values = {}, .where = {}});
  Measure error{.id = "error", .what = "L2", .field = "displacement", .of = "", .unit = "1", .where = {}};
  error.against_truth = true;
  study.measures.push_back(error);
  study.measures.push_back(
      {.quantity = Quantity::time, .id = "time", .what = "total", .field = "", .of = "", .unit = "s", .where = {}});
  study.charts.push_back({.id = "c",
                          .title = "T",
                          .x = "unknowns",
                          .y = "error",
                          .group = {"kind"},
                          .axes = {},
                          .slopes = {-0.667},
                          .where = {}});
  return study;
}

TEST(Chart, NamesItsCurvesAndMarksWhatFailed) {
  const std::string script = gnuplot_script(convergence(), study().charts[0], {});
  EXPECT_THAT(script, HasSubstr("set label \"tet4\""));
  EXPECT_THAT(script, HasSubstr("set label \"tet10\""));
  EXPECT_THAT(script, HasSubstr("$curve0 << EOD\n100 0.4 "));
  const std::size_t low = script.find("set yrange [") + 12;
  EXPECT_THAT(script, HasSubstr("$failed << EOD\n51200 " + script.substr(low, script.find(':', low) - low) + "\n"));
  EXPECT_THAT(script, HasSubstr("set label \"-0.667\""));
  EXPECT_THAT(script, Not(HasSubstr("errorbars")));
}

// tet10 is the second of the table: it has the second colour and mark where it is drawn alone, too.
TEST(Chart, AMethodLooksTheSameInEachChart) {
  Chart chart = study().charts[0];
  EXPECT_THAT(gnuplot_script(convergence(), chart, {}),
              HasSubstr("$curve1 using 1:2 with linespoints lw 2 dt 1 pt 5 ps 1.1 lc rgb \"#D55E00\""));
  chart.only = {{"kind", "tet10"}};
  EXPECT_THAT(gnuplot_script(convergence(), chart, {}),
              HasSubstr("$curve0 using 1:2 with linespoints lw 2 dt 1 pt 5 ps 1.1 lc rgb \"#D55E00\""));
}

TEST(Chart, TimesHaveErrorBars) {
  Chart chart = study().charts[0];
  chart.x = "time";
  const std::string script = gnuplot_script(convergence(), chart, {.labels = {{"time", "time [s]"}}});
  EXPECT_THAT(script, HasSubstr("xerrorbars"));
  EXPECT_THAT(script, HasSubstr("set xlabel \"time [s]\""));
  EXPECT_THAT(script, HasSubstr("set label \"1 run without a result\"")) << "which has no place on this axis";
  EXPECT_THAT(script, Not(HasSubstr("$failed")));
}

TEST(Chart, ShowsWhatTheoryKnows) {
  Chart chart = study().charts[0];
  chart.theory = {Formula("0.4*(X/100)^(-2/3)")};
  chart.limits = {1000, 1e9};
  const std::string script = gnuplot_script(convergence(), chart, {});
  EXPECT_THAT(script, HasSubstr("$theory0 << EOD\n"));
  EXPECT_THAT(script, HasSubstr("plot $theory0 with lines"));
  EXPECT_THAT(script, HasSubstr("set label \"1e+03\""));
  EXPECT_THAT(script, Not(HasSubstr("set label \"1e+09\""))) << "outside the chart";
}

TEST(Map, ColoursEachRunByItsFate) {
  const Table table{{"dt", "k", "error", "status", "warnings", "recovered"},
                    {{"1", "1", "0.01", "done", "", ""},
                     {"10", "1", "0.2", "done", "", "3 steps failed and were halved"},
                     {"1", "100", "", "not converged", "", ""},
                     {"10", "100", "7", "done", "", ""},
                     {"20", "100", "7", "done", "the motion is not to be trusted", ""},
                     {"20", "1", "0.01", "done", "", "3 steps failed and were halved"}}};
  Chart chart{.id = "m",
              .title = "",
              .x = "dt",
              .y = "k",
              .group = {},
              .only = {},
              .axes = {},
              .slopes = {},
              .color = "error",
              .where = {}};
  EXPECT_EQ(fate(table, 0, chart), Fate::accurate);
  EXPECT_EQ(fate(table, 1, chart), Fate::inaccurate);
  EXPECT_EQ(fate(table, 2, chart), Fate::said_so);
  EXPECT_EQ(fate(table, 3, chart), Fate::wrong);
  EXPECT_EQ(fate(table, 4, chart), Fate::warned);
  EXPECT_EQ(fate(table, 5, chart), Fate::recovered);
  chart.theory = {Formula("10/X")};
  const std::string script = gnuplot_script(table, chart, {});
  // Cells meet halfway between the values in the logarithm: at dt = sqrt(10) and k = 10.
  EXPECT_THAT(script,
              HasSubstr("from first 0.31622777,0.1 to first 3.1622777,10 behind fs solid border lc rgb \"#FFFFFF\" fc "
                        "rgb \"#009E73\""));
  EXPECT_THAT(script, HasSubstr("plot $theory0 with lines"));
}

TEST(Map, ShowsWhereTheReferenceFailed) {
  Table table{{"dt", "k", "error", "status"}, {{"1", "1", "0.01", "done"}, {"10", "1", "", "not converged"}}};
  Chart chart{.id = "m", .title = "", .x = "dt", .y = "k", .group = {}, .only = {}, .axes = {}, .slopes = {}};
  chart.color = "error";
  EXPECT_THAT(gnuplot_script(table, chart, {}), Not(HasSubstr("no reference")));
  table.rows[1][3] = "no reference";
  const std::string script = gnuplot_script(table, chart, {});
  EXPECT_THAT(script, HasSubstr("set label \"no reference\""));
  EXPECT_THAT(script, HasSubstr("lc rgb \"#FFFFFF\" fc rgb \"#DDDDDD\""));
}

TEST(Map, WordsStandSideBySide) {
  const Table table{{"law", "load", "error", "status"},
                    {{"log", "1", "0.01", "done"}, {"cubic", "1", "0.01", "done"}, {"log", "10", "0.01", "done"}}};
  Chart chart{.id = "m", .title = "", .x = "load", .y = "law", .group = {}, .only = {}, .axes = {}, .slopes = {}};
  chart.color = "error";
  const std::string script = gnuplot_script(table, chart, {});
  EXPECT_THAT(script, HasSubstr("set ytics (\"log\" 1, \"cubic\" 2) noenhanced"));
  EXPECT_THAT(script, HasSubstr("to first 3.1622777,1.5 behind"));
  EXPECT_THAT(script, Not(HasSubstr("set logscale y")));
  chart.axes.log_x = false;
  EXPECT_THAT(gnuplot_script(table, chart, {}), HasSubstr("set xtics (\"1\" 1, \"10\" 10)"));
}

TEST(Chart, WordsStandInARow) {
  Chart chart = study().charts[0];
  chart.x = "kind";
  chart.group = {"n"};
  EXPECT_THAT(gnuplot_script(convergence(), chart, {}), HasSubstr("set xtics (\"tet4\" 1, \"tet10\" 2)"));
}

TEST(Chart, WithoutNumbersItIsRefused) {
  Chart chart = study().charts[0];
  chart.y = "reason";
  EXPECT_THROW(gnuplot_script(convergence(), chart, {}), Error);
}

TEST(Chart, GnuplotDrawsIt) {
  const tiny::Folder folder;
  const std::string problem = draw(convergence(), study().charts[0], {}, folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "c.gp"));
  if (problem.find("not installed") != std::string::npos) GTEST_SKIP() << problem;
  EXPECT_EQ(problem, "");
  for (const char* file : {"c.svg", "c.png"})
    EXPECT_GT(std::filesystem::file_size(folder.path() / file), 1000U) << file;
}

TEST(Page, SaysWhatAccuracyCosts) {
  const std::string page = to_markdown(make_page(study(), convergence(), "About."));
  EXPECT_THAT(page, HasSubstr("# Elements\n\nAbout. 6 runs: 5 done, 1 not converged."));
  EXPECT_THAT(page, HasSubstr("![c](c.svg)"));
  EXPECT_THAT(page, HasSubstr("| error | unknowns | tet4 | -0.67 | ± 0.00 | 3 |  |  |  |"));  // 0.4 (n / 100)^(-2/3)
  EXPECT_THAT(page, HasSubstr("| error | unknowns | tet10 | -1.33 | two runs only | 2 |  |  |  |"));
  EXPECT_THAT(page, HasSubstr("| 10 % | 0.1 | 10 % | tet4 | 2 |"));
  EXPECT_THAT(page, HasSubstr("| 1 % | 2 | 0.5 % | tet10 | 2 |"));
  EXPECT_THAT(page, HasSubstr("| 0.1 % | not reached |  |  |  |"));
  // 5 % on the lines of the logarithms: tet4 at 800 * 2^(3/2), tet10 at 800 * (8/5)^(3/4).
  EXPECT_THAT(page, HasSubstr("| 5 % | tet4 | 2263 | 1.99 |"));
  EXPECT_THAT(page, HasSubstr("| 5 % | tet10 | 1138 | 1.00 |"));
  EXPECT_THAT(page, HasSubstr("| tet10 | 4 | not converged | it stalled |"));
}

// Errors that grow with an amount: 1 % is passed at 0.1, halfway in the logarithms; 10 % by no run, 0.1 % by all.
TEST(Page, SaysWhereErrorsPassRoundNumbers) {
  const Table table{{"kind", "n", "status", "error", "time", "reason", "key"},
                    {{"small", "0.01", "done", "0.002", "1", "", "k"},
                     {"small", "1", "done", "0.05", "1", "", "k"},
                     {"exact", "0.01", "done", "0.002", "1", "", "k"},
                     {"exact", "1", "done", "0.0005", "1", "", "k"}}};
  Study along = study();
  along.charts[0].x = "n";
  const std::string page = to_markdown(make_page(along, table, "About."));
  EXPECT_THAT(page, HasSubstr("| error | n | small | below | below | 0.1 | above |"));
  EXPECT_THAT(page, HasSubstr("| error | n | exact | below | below | below | 0.1 |"));
}

// All runs of a study of time steps have the same unknowns: nothing to compare there.
TEST(Page, ComparesOnlyCostsThatDiffer) {
  Table table = convergence();
  EXPECT_THAT(to_markdown(make_page(study(), table, "")),
              HasSubstr("| error | method | unknowns | to the best | time |"));
  for (auto& row : table.rows) row[3] = "270";
  EXPECT_THAT(to_markdown(make_page(study(), table, "")), HasSubstr("| error | method | time | to the best |"));
}

TEST(Page, FitsTheFinerHalfToo) {
  Table table{{"kind", "n", "status", "error", "time", "reason", "key"}, {}};
  // Order 1 on the coarse half, 2 on the finer one.
  for (const auto& [n, error] : {std::pair{"1", "1"}, {"2", "0.5"}, {"4", "0.25"}, {"8", "0.0625"}, {"16", "0.015625"}})
    table.rows.push_back({"tet4", n, "done", error, "1", "", "k"});
  Study along = study();
  along.charts[0].x = "n";
  EXPECT_THAT(to_markdown(make_page(along, table, "")), HasSubstr("| 5 | -2.00 | ± 0.00 | 3 |"));
}

TEST(Page, SaysWhyAChartIsMissing) {
  const Page page = make_page(study(), convergence(), "", {{"c", "no run has numbers"}});
  EXPECT_THAT(to_markdown(page), HasSubstr("Chart c is not drawn: no run has numbers"));
  EXPECT_THAT(to_markdown(page), Not(HasSubstr("c.svg")));
}

TEST(Page, IsOneFileOfHtml) {
  const tiny::Folder folder;
  folder.add("c.svg", "<?xml?><svg>drawn</svg>");
  const std::string html = to_html(make_page(study(), convergence(), "a < b"), folder.path());
  EXPECT_THAT(html, HasSubstr("<h1>Elements</h1>"));
  EXPECT_THAT(html, HasSubstr("a &lt; b"));
  EXPECT_THAT(html, HasSubstr("<figure><svg>drawn</svg></figure>"));
}

}  // namespace
}  // namespace msml
