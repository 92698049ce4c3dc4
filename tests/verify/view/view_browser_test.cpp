/// \file
/// Journeys through the page of a view in a real browser: an added script moves its controls and
/// writes their results, which are compared with exact numbers.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/browser_test.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/number.hpp"
#include "verify/mesh/mesh_file.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/view/asked_solvers.hpp"
#include "verify/view/query_facts.hpp"
#include "verify/view/step_facts.hpp"
#include "verify/view/view_page.hpp"

namespace touchstone::verify::view::view_browser_test {
namespace {

using exact::Rational;
using tests::PosedQuery;

/// Helpers of the tests' scripts. The results are written to an element, as JSON.
constexpr std::string_view tools = R"(
const find = (id) => document.getElementById(id);
const all = (selector) => Array.from(document.querySelectorAll(selector));
const text = (selector) => all(selector).map((element) => element.textContent);
const move = (id, value) => { find(id).value = value; find(id).dispatchEvent(new Event("input")); };
const choose = (name, value) => document.querySelector(`input[name=${name}][value="${value}"]`).click();
const paste = (words) => { find("text").value = words; find("draw").click(); return find("drawn").textContent; };
const press = (key) => document.dispatchEvent(new KeyboardEvent("keydown", { key }));
const pixels = (id) => {
  const canvas = document.querySelector(`#${id} canvas`);
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  copy.getContext("2d").drawImage(canvas, 0, 0);
  const data = copy.getContext("2d").getImageData(0, 0, copy.width, copy.height).data;
  return data.filter((value, i) => i % 4 === 3 && value > 0).length;
};
const say = (result) => {
  const element = document.createElement("pre");
  element.id = "result";
  element.textContent = JSON.stringify(result);
  document.body.append(element);
};
)";

class ViewBrowser : public tests::BrowserTest {
 protected:
  /// The result of the script on a page of these queries.
  /// \param before a script that runs before the page's
  [[nodiscard]] nlohmann::json result_of(const std::vector<PosedQuery>& posed,
                                         const std::string& script, int width = 1200) const {
    std::vector<ViewedQuery> viewed;
    for (const PosedQuery& one : posed) {
      viewed.push_back({.label = "query", .query = base::AnyQuery(one.kind, one.query)});
    }
    return result_on(page_of(viewed), script, width);
  }

  /// The result of the script on any page.
  [[nodiscard]] nlohmann::json result_on(std::string page, const std::string& script,
                                         int width = 1200, const std::string& before = "") const {
    page.insert(page.rfind("</body>"),
                fmt::format("<script>{}(() => {{{}}})();</script>", tools, script));
    if (!before.empty()) page.insert(page.find("<main"), "<script>" + before + "</script>");
    const std::string dom = load(page, width);
    EXPECT_EQ(complaints(), "");
    const std::string start = R"(<pre id="result">)";
    const std::size_t found = dom.find(start);
    if (found == std::string::npos) {
      ADD_FAILURE() << "the script has said nothing";
      return {};
    }
    const std::size_t first = found + start.size();
    return nlohmann::json::parse(dom.substr(first, dom.find("</pre>", first) - first));
  }

  [[nodiscard]] std::string page_of(const std::vector<ViewedQuery>& viewed) const {
    std::vector<nlohmann::json> facts;
    for (const ViewedQuery& one : viewed)
      facts.push_back(query_facts(one, view::ask(asked_, one).answers));
    return view_page(facts, "touchstone view", {}, solvers_);
  }

  void ask(const solvers::Solver& solver) { asked_.push_back(&solver); }

 protected:
  /// The script of solvers in WebAssembly, if the page has any.
  std::string solvers_ = {};

 private:
  std::vector<const solvers::Solver*> asked_;
};

PosedQuery falling(double end = -2.0) { return tests::over_triangle(1, 1, 1, end); }

/// A query with coordinates of every exponent.
PosedQuery of_any_size(ContactKind kind) {
  tests::Random random(7);
  PosedQuery posed{kind, {}};
  for (double& x : posed.query.coordinates) x = random.finite_double();
  return posed;
}

/// Rational curves with coordinates and weights of very different sizes.
base::AnyQuery odd_curves() {
  tests::Random random(8);
  const QueryShape shape{ContactKind::vertex_face, 3, true};
  std::vector<double> numbers(shape.numbers_of_query());
  for (double& x : numbers) x = std::ldexp(random.uniform(-1.0, 1.0), random.between(-60, 60));
  for (std::size_t i = 3; i < numbers.size(); i += 4) numbers[i] = random.uniform(0x1p-20, 5.0);
  return {shape, numbers};
}

/// The positions of all points at a time, by de Casteljau's algorithm on weights and weighted
/// positions, as the page writes rationals.
std::vector<std::string> positions(const base::AnyQuery& query, const Rational& t) {
  std::vector<std::string> result;
  for (const Trajectory& curve : to_curved(query.queries(), 0)) {
    std::vector<std::array<Rational, 4>> row;
    for (std::size_t j = 0; j < curve.control.size(); ++j) {
      const Rational weight(curve.weights.empty() ? 1.0 : curve.weights[j]);
      const auto& [x, y, z] = curve.control[j];
      row.push_back({weight * Rational(x), weight * Rational(y), weight * Rational(z), weight});
    }
    for (; row.size() > 1; row.pop_back()) {
      for (std::size_t j = 0; j + 1 < row.size(); ++j) {
        for (std::size_t k = 0; k < 4; ++k) {
          row[j].at(k) = (1 - t) * row[j].at(k) + t * row[j + 1].at(k);
        }
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      result.push_back(Rational(row[0].at(k) / row[0][3]).get_str());
    }
  }
  return result;
}

/// Also where the browser has no WebGL, which the pictures need.
TEST_F(ViewBrowser, TheSliderMovesThePointsExactly) {
  const std::vector<base::AnyQuery> motions{
      {ContactKind::vertex_face, of_any_size(ContactKind::vertex_face).query},
      {ContactKind::edge_edge, of_any_size(ContactKind::edge_edge).query},
      odd_curves()};
  std::vector<ViewedQuery> viewed;
  for (const base::AnyQuery& motion : motions) viewed.push_back({.query = motion});
  const std::string page = page_of(viewed);
  for (const std::string without : {"", "HTMLCanvasElement.prototype.getContext = () => null;"}) {
    const nlohmann::json result = result_on(page, R"(
      choose("format", "rational");
      const read = (step) => { move("time", step); return text("#at_now code"); };
      const visit = (_, i) => { all("#list button")[i].click(); return [0, 1, 1365, 2048, 4096].map(read); };
      say({ steps: find("time").max, all: all("#list button").map(visit), without: text("#no_pictures"),
        drawn: ["motion", "corners"].map((id) => (document.querySelector(`#${id} canvas`) ? pixels(id) : 0)) });
    )",
                                            1200, without);
    ASSERT_EQ(result.at("steps"), "4096");
    const std::array<int, 5> steps{0, 1, 1365, 2048, 4096};
    for (std::size_t motion = 0; motion < motions.size(); ++motion) {
      for (std::size_t i = 0; i < steps.size(); ++i) {
        EXPECT_EQ(result.at("all").at(motion).at(i),
                  positions(motions[motion], Rational(steps[i], 4096)));
      }
    }
    for (const nlohmann::json& count : result.at("drawn")) EXPECT_EQ(count > 30, without.empty());
    if (!without.empty()) {
      EXPECT_EQ(result.at("without"),
                nlohmann::json::array(
                    {"This browser has no WebGL, which the pictures need. All numbers are here."}));
    }
  }
}

TEST_F(ViewBrowser, ShowsContactTimeAndSolvers) {
  const auto certified = solvers::solver_in_process(solvers::find_method("certified"), {});
  const auto inclusion = solvers::solver_in_process(solvers::find_method("tight_inclusion"), {});
  ask(*certified);
  ask(*inclusion);
  const nlohmann::json result = result_of({falling(), falling(0x1p-52)}, R"(
    const look = () => ({
      verdict: find("sentence").textContent, names: text("#rows .name"),
      marks: all("#rows .mark.toi, #rows .mark.approach").map((mark) => mark.style.left),
      subintervals: all("#rows .subinterval").map((bar) => bar.textContent + bar.title),
      cursor: document.querySelector("#rows .cursor").style.left, now: find("now").textContent,
      readout: find("readout").textContent, drawn: [pixels("motion"), pixels("corners")],
      names_there: text("#motion .names span") });
    const first = look();
    choose("format", "rational");
    const at_contact = text("#at_now code");
    press("n");
    const second = look();
    find("enlarge").click();
    say([first, at_contact, second, look(), find("scale").textContent]);
  )");
  const nlohmann::json& first = result.at(0);
  EXPECT_EQ(first.at("verdict"),
            "vertex-face: collides. Time of impact: 1/3 ≈ 0.3333333333333333, (u, v) = (0.25, "
            "0.25).");
  EXPECT_EQ(first.at("names"),
            nlohmann::json::array({"oracle", "certificate", "certified", "tight_inclusion"}));
  EXPECT_EQ(first.at("marks").at(0).get<std::string>().substr(0, 7), "33.3333");
  EXPECT_EQ(first.at("cursor").get<std::string>().substr(0, 7), "33.3333");
  EXPECT_EQ(first.at("now"), "0.3333333333333333 (toi)");
  EXPECT_EQ(first.at("readout"), "Contact now; nearest at (u, v) = (0.25, 0.25).");
  EXPECT_EQ(first.at("names_there"), nlohmann::json::array({"v", "f0", "f1", "f2", "contact"}));
  EXPECT_EQ(result.at(1), positions({ContactKind::vertex_face, falling().query}, Rational(1, 3)));
  const nlohmann::json& second = result.at(2);
  EXPECT_EQ(second.at("verdict"), "vertex-face: free.");
  EXPECT_EQ(second.at("subintervals"), nlohmann::json::array({"face +separated by face +"}));
  EXPECT_EQ(result.at(4).get<std::string>().substr(0, 22), "Radius seen: 4.44e-16 ");
  for (const std::size_t i : std::array<std::size_t, 3>{0, 2, 3}) {
    for (const nlohmann::json& count : result.at(i).at("drawn")) EXPECT_GT(count, 500) << i;
  }
}

TEST_F(ViewBrowser, FitsATelephoneWhereWhatIsCopiedIsTheSameQueryWhenPasted) {
  const nlohmann::json result = result_of({falling(), of_any_size(ContactKind::edge_edge)}, R"(
    const copied = [];
    for (const index of [0, 1]) {
      for (const name of ["Cpp", "CSV", "JSON"]) {
        all("#list button")[index].click();
        find(`copy_${name}`).click();
        const words = find("text").value;
        all("#list button")[1 - index].click();
        copied.push([paste(words), document.querySelector("#list [aria-current] b").textContent === String(index)]);
      }
    }
    for (const button of all("#list button")) button.append(" of a long name".repeat(40));
    say({ copied, drawn: pixels("motion"), wide: document.documentElement.scrollWidth - window.innerWidth,
      cut: all("#list button").filter((button) => button.scrollHeight > button.clientHeight + 1).length });
  )",
                                          500);
  EXPECT_EQ(result.at("copied").size(), 6U);
  for (const nlohmann::json& one : result.at("copied")) {
    EXPECT_EQ(one, nlohmann::json::array({"This page holds its answer.", true}));
  }
  EXPECT_LE(result.at("wide"), 0);
  EXPECT_GT(result.at("drawn"), 50);
  EXPECT_EQ(result.at("cut"), 0) << "rows of the list cover each other";
}

TEST_F(ViewBrowser, DrawsWhatIsPastedWithoutAVerdict) {
  const nlohmann::json result = result_of({falling()}, R"(
    choose("format", "hexadecimal");
    const start = () => text("#at_t_0 code").slice(0, 3).concat(find("sentence").textContent.split(".")[0]);
    const rest = "0 0 0 4 0 0 0 4 0  1 1 -3 0 0 0 4 0 0 0 4 0";
    const results = [
      `0.1 1/3 -0x1.8p-3 ${rest}`,
      `{"kind": "edge-edge", "coordinates": ["0x1p+0", 2, 3, ${rest.replace(/ +/g, ", ")}]}`,
      `[[1, 2, 4], ${rest.replace(/ +/g, ", ")}]`,
      `x,y,z,label\n1,2,7,0\n${rest.match(/\S+ \S+ \S+/g).map((row) => row.replace(/ /g, ",") + ",0").join("\n")}`,
    ].map((words) => [paste(words), ...start()]);
    const list = (x) => `[${Array(24).fill(x).join(",")}]`;
    const faults = [
      "1 2 3", "", `1e400 0 0 ${rest}`, "{\"coordinates\": [1]}", `{"coordinates": ${list("null")}}`,
      `{"coordinates": ${list(1)}, "separation": {"min_separation": -1}}`, `NaN 0 0 ${rest}`, `1/0 0 0 ${rest}`,
      "<img src=x onerror=say(1)><script>say(1)<\/script>", "1".repeat(900000) + "g", "0x" + "f".repeat(900000) + "g",
      "/*".repeat(400000), "[".repeat(900000), "1 ".repeat(600000),
    ].map(paste);
    const images = all("main img").length;
    results.push([paste(`\u22120.5 0 1e\u22123 ${rest}`), ...start()]);
    say({ results, faults, images, drawn: pixels("motion"), rows: text("#rows .said") });
  )");
  const std::vector<std::array<std::string, 4>> expected{
      {"0x1.999999999999ap-4", "0x1.5555555555555p-2", "-0x1.8p-3", "vertex-face"},
      {"0x1p+0", "0x1p+1", "0x1.8p+1", "edge-edge"},
      {"0x1p+0", "0x1p+1", "0x1p+2", "vertex-face"},
      {"0x1p+0", "0x1p+1", "0x1.cp+2", "vertex-face"},
      {"-0x1p-1", "0x0p+0", "0x1.0624dd2f1a9fcp-10", "vertex-face"},
  };
  ASSERT_EQ(result.at("results").size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& [x, y, z, kind] = expected[i];
    EXPECT_EQ(result.at("results").at(i),
              nlohmann::json::array(
                  {"Drawn. This page holds no answer to it.", x, y, z, kind + ": not decided"}));
  }
  EXPECT_EQ(result.at("faults").at(0), "Not drawn: there are 3 numbers, not the 24 of a query.");
  EXPECT_EQ(result.at("faults").at(1), "Not drawn: there are 0 numbers, not the 24 of a query.");
  EXPECT_EQ(result.at("faults").at(2), "Not drawn: “1e400” is no finite number.");
  for (const nlohmann::json& fault : result.at("faults")) {
    const auto words = fault.get<std::string>();
    EXPECT_TRUE(words.starts_with("Not drawn: ")) << words;
  }
  EXPECT_EQ(result.at("images"), 0);
  EXPECT_GT(result.at("drawn"), 500);
  EXPECT_EQ(result.at("rows").at(0), "not asked: give this query to the tool");
}

TEST_F(ViewBrowser, DrawsEveryScale) {
  std::vector<PosedQuery> posed{of_any_size(ContactKind::vertex_face),
                                of_any_size(ContactKind::edge_edge)};
  for (const double scale : {1e-300, 4e-324}) {
    posed.push_back(falling());
    for (double& x : posed.back().query.coordinates) x *= scale;
  }
  // Points in one place, at rest.
  posed.push_back(tests::edge_edge({}, {}));
  const nlohmann::json result = result_of(posed, R"(
    say(all("#list button").map((_, i) => {
      all("#list button")[i].click();
      return [0, 1000].map((zoom) => {
        move("zoom", zoom);
        move("time", 2048);
        const drawn = [pixels("motion"), pixels("corners")];
        find("follow").click();
        move("time", 1024);
        const followed = [pixels("motion"), pixels("corners")];
        find("follow").click();
        return { drawn, followed, text: find("query").textContent };
      });
    }));
  )",
                                          500);
  ASSERT_EQ(result.size(), posed.size());
  for (std::size_t i = 0; i < posed.size(); ++i) {
    for (const nlohmann::json& zoom : result.at(i)) {
      // The smallest drawing is one point, a disc of nine pixels across.
      EXPECT_GT(zoom.at("followed").at(0), 30) << i;
      EXPECT_GT(zoom.at("followed").at(1), 30) << i;
      EXPECT_GT(zoom.at("drawn").at(1), 30) << i << ": the origin is always seen";
      for (const std::string word : {"NaN", "undefined", "Infinity", "null"}) {
        EXPECT_EQ(zoom.at("text").get<std::string>().find(word), std::string::npos)
            << i << zoom.at("text");
      }
    }
  }
}

/// A script that applies the rules for paper instead of those for screens, and finds the visible
/// parts, and those that are cut off.
constexpr std::string_view on_paper = R"(
  for (const sheet of document.styleSheets) {
    for (const { media } of sheet.cssRules) {
      if (media) media.mediaText = media.mediaText === "print" ? "all" : media.mediaText.includes("screen") ? "not all" : media.mediaText;
    }
  }
  const isSeen = (element) => element.getClientRects().length > 0 && getComputedStyle(element).visibility === "visible";
  const unseen = (selectors) => selectors.filter((selector) => all(selector).length === 0 || !all(selector).every(isSeen));
  const controls = () => all("button, input, textarea, select").filter((it) => isSeen(it) && !it.closest("#pairs")).length;
  const cut = (selector) => all(selector).filter((it) => it.scrollHeight > it.clientHeight + 1 || it.scrollWidth > it.clientWidth + 1).length;
)";

TEST_F(ViewBrowser, PrintsWhatIsShownWithoutTheControls) {
  const auto inclusion = solvers::solver_in_process(solvers::find_method("tight_inclusion"), {});
  ask(*inclusion);
  const nlohmann::json result =
      result_of({falling(0x1p-52), of_any_size(ContactKind::edge_edge)}, std::string(on_paper) + R"(
    choose("format", "rational");
    const shown = ["h1", "#label", "#sentence", "#motion canvas", "#corners canvas", "#motion .names span", "#scale",
      "#now", "#rows .name", "#rows .said", "#rows .track", "#readout", "#points td", "footer"];
    const first = { unseen: unseen(shown), said: text("#rows .said.wrong") };
    press("n");
    say({ ...first, controls: controls(), cut: cut("#points code, .said, #sentence"),
      wide: document.documentElement.scrollWidth <= window.innerWidth, drawn: [pixels("motion"), pixels("corners")] });
  )",
                718);
  EXPECT_EQ(result.at("unseen"), nlohmann::json::array());
  EXPECT_NE(result.at("said").at(0).get<std::string>().find("✗ false positive"), std::string::npos)
      << "in words, for a grey copy";
  EXPECT_EQ(result.at("controls"), 0);
  EXPECT_EQ(result.at("cut"), 0) << "numbers of a thousand digits are printed whole";
  EXPECT_EQ(result.at("wide"), true);
  for (const nlohmann::json& count : result.at("drawn")) EXPECT_GT(count, 30);
}

// ---- A step -------------------------------------------------------------------------------------

/// A pyramid that rises from y = −2 to y = 2, and two points at rest above it, each a vertex of no
/// element.
std::string page_of_a_step() {
  const std::vector<std::array<double, 3>> coordinates{
      {-1, -2, -1}, {1, -2, -1},        {1, -2, 1},         {-1, -2, 1},
      {0, -1, 0},   {0.125, 1, 0.0625}, {-0.125, 2, 0.0625}};
  mesh::Mesh mesh = mesh::make_mesh(
      coordinates, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 1, 2}, {0, 2, 3}}, {});
  mesh.points = {5, 6};
  mesh::Vertices after = mesh.vertices;
  for (Eigen::Index i = 0; i < 5; ++i) after(i, 1) += 4;
  const ViewedStep step = find_collisions("rising", mesh, mesh.vertices, after, {});
  std::vector<nlohmann::json> facts;
  for (const ViewedQuery& query : first_queries(step, 1)) facts.push_back(query_facts(query, {}));
  return view_page(facts, "touchstone view", step_facts(step));
}

TEST_F(ViewBrowser, PairsOfAStepLeadToTheirQueries) {
  const nlohmann::json result = result_on(page_of_a_step(), R"(
    choose("format", "rational");
    const look = () => ({ label: find("label").textContent, verdict: find("sentence").textContent.split(".")[0],
      start: text("#at_t_0 code").slice(0, 3), chosen: text("#pairs .chosen span"), past: text("#pairs .past span").length });
    const marks = [0, 4096].map((step) => { move("step_time", step); return find("step_now").textContent; });
    const names = text("#pairs span");
    all("#pairs button")[0].click();
    const first = look();
    all("#pairs button")[names.length - 1].click();
    say({ verdict: find("step_verdict").textContent, names, marks, first, last: look(),
      drawn: [pixels("mesh"), pixels("motion")] });
  )");
  const std::string verdict = result.at("verdict");
  EXPECT_TRUE(verdict.find(" collisions, the first at t = ") != std::string::npos) << verdict;
  const std::size_t pairs = result.at("names").size();
  ASSERT_GE(pairs, 2U);
  EXPECT_EQ(result.at("marks").at(0), fmt::format("t = 0, 0 of {} have collided", pairs));
  EXPECT_EQ(result.at("marks").at(1), fmt::format("t = 1, {0} of {0} have collided", pairs));
  const nlohmann::json &first = result.at("first"), &last = result.at("last");
  EXPECT_EQ(first.at("label"), "rising: " + result.at("names").at(0).get<std::string>());
  EXPECT_EQ(first.at("verdict"), "vertex-face: collides");
  EXPECT_EQ(first.at("start"), nlohmann::json::array({"1/8", "1", "1/16"}));
  EXPECT_GE(first.at("past"), 1);
  EXPECT_EQ(last.at("verdict"), "vertex-face: not decided") << "the page holds one answer";
  EXPECT_EQ(last.at("start"), nlohmann::json::array({"-1/8", "2", "1/16"}));
  EXPECT_EQ(last.at("chosen"), nlohmann::json::array({result.at("names").at(pairs - 1)}));
  EXPECT_EQ(last.at("past"), pairs);
  for (const nlohmann::json& count : result.at("drawn")) EXPECT_GT(count, 200);
}

/// A triangle that a needle passes through and another triangle crosses; a click enlarges the pair.
TEST_F(ViewBrowser, ShowsWhatIntersectsAtRest) {
  const std::vector<std::array<double, 3>> coordinates{{-1, 0, -1},   {1, 0, -1},  {0, 0, 1},
                                                       {0, -1, 0},    {0, 1, 0},   {0, 0, -2},
                                                       {0.25, -1, 0}, {0.25, 1, 0}};
  const mesh::Mesh mesh =
      mesh::make_mesh(coordinates, {{0, 1, 2}, {3, 4, 5}}, std::vector<fast::Edge>{{6, 7}});
  const std::vector<fast::Intersection> found =
      fast::intersections(mesh.vertices, {.edges = mesh.edges, .faces = mesh.faces});
  ASSERT_EQ(found.size(), 2U);
  const auto name = [](const fast::Intersection& one) {
    return fmt::format("pair with {} (6 7)", one.numbers[1]);
  };
  const nlohmann::json result =
      result_on(view_page({}, "touchstone intersections",
                          resting_facts("a/" + std::string(300, 'x'), mesh, found, name)),
                R"(
      const look = () => [text("#pairs .chosen span"), text("#mesh .names span"), find("step_now").textContent, pixels("mesh")];
      const first = look();
      all("#pairs button")[1].click();
      const second = look();
      find("step_all").click();
      const unseen = ["step_play", "step_time", "query", "exchange", "nothing"].filter((id) => find(id).offsetParent !== null);
      say({ verdict: find("step_verdict").textContent, pairs: text("#pairs button"), first, second, all: pixels("mesh"), unseen,
        wide: document.documentElement.scrollWidth - window.innerWidth });
    )",
                390);
  EXPECT_EQ(result.at("verdict"), "2 intersections.");
  EXPECT_EQ(
      result.at("pairs"),
      (nlohmann::json{"pair with 1 (6 7) edge through face",
                      fmt::format("pair with {} (6 7) edge through face", found[1].numbers[1])}));
  EXPECT_EQ(result.at("first").at(0), nlohmann::json::array({"pair with 1 (6 7)"}));
  EXPECT_EQ(result.at("first").at(1), nlohmann::json::array({"pair with 1"}));
  EXPECT_EQ(result.at("first").at(2), "edge through face: 0 0 -1 to 0 0 0");
  EXPECT_EQ(result.at("second").at(2), "edge through face: 0.25 0 0");
  for (const char* const moment : {"first", "second"}) EXPECT_GT(result.at(moment).at(3), 200);
  EXPECT_GT(result.at("all"), 200);
  EXPECT_EQ(result.at("unseen"), nlohmann::json::array());
  EXPECT_LE(result.at("wide"), 0);
}

// ---- A page that decides ------------------------------------------------------------------------

/// In the place of a worker with the solvers in WebAssembly: what it is asked is kept. A query
/// collides if its first point ends below 0.
constexpr const char* fake_worker = R"(
const asked = [];
class Worker {
  constructor() { setTimeout(() => this.onmessage({ data: {} })); }
  postMessage(query) {
    asked.push(query);
    const { kind, coordinates, separation, norm } = query;
    const facts = { label: "", kind, coordinates: coordinates.map(String), min_separation: String(separation), norm, notes: [],
      approach: null, certificate: null, answers: [], truth: { collides: coordinates[14] < 0, text: "" } };
    setTimeout(() => this.onmessage({ data: { facts } }));
  }
}
)";

/// A page that decides after each change, follows its address, and whose points can be dragged. Of
/// changes that come faster than answers the last is asked.
TEST_F(ViewBrowser, DecidesAfterEachChange) {
  solvers_ = "// not read\n";
  const nlohmann::json result = result_on(
      page_of({{.label = "query", .query = base::AnyQuery(falling(1).kind, falling(1).query)}}),
      R"((async () => {
    const later = () => new Promise((next) => setTimeout(next, 20));
    const until = async (isSo) => { while (!isSo()) await later(); };
    const settled = async () => { for (let i = 0; i < 9; ++i) await later(); };
    await until(() => find("verdict"));
    const seen = () => [find("verdict").textContent, asked.length];
    const last = () => asked[asked.length - 1];
    const change = (element, value) => { element.value = value; element.dispatchEvent(new Event("change")); };
    const input = (label) => document.querySelector(`#points input[aria-label="${label}"]`);
    const edits = [seen()];
    change(input("z of v at t = 1"), "-0x1p-3");
    await settled();
    edits.push(seen());
    change(find("distance"), "0.5");
    choose("asked_norm", "linf");
    choose("asked_kind", "edge-edge");
    await settled();
    edits.push(seen());
    change(input("x of ea1 at t = 0"), "nonsense");
    await settled();
    edits.push(seen());
    const edited = last();
    paste("edge-edge 0 0 1 0 0 0 1 0 0 2 0 0  0 0 3 0 0 0 1 0 0 2 0 0");
    await settled();
    edits.push([find("drawn").textContent, find("verdict").textContent]);
    const pasted = location.hash;

    const go = async (hash) => {
      history.replaceState(null, "", hash);
      window.dispatchEvent(new HashChangeEvent("hashchange"));
      await settled();
      return find("query").hidden ? find("nothing").textContent : find("verdict").textContent;
    };
    const query = (kind, end) => `#q=${kind},1,1,0.5,0,0,0,4,0,0,0,4,0,1,1,${end},0,0,0,4,0,0,0,4,0`;
    const separated = [await go(`${query("edge_edge", "1e-3")}&d=0.25`), last()];
    const visited = [];
    for (const hash of [query("vertex-face", "-0x1p-3"), "#q=vertex_face,1,2", "#q=face_face", `${query("vertex_face", 1)}&d=-1`,
      query("vertex_face", 1)]) visited.push(await go(hash));

    find("move").click();
    move("time", 4096);
    const canvas = document.querySelector("#motion canvas");
    canvas.setPointerCapture = () => {};
    // A name stands beside its point, to the left or to the right, and a little above.
    const { left, right, top } = all("#motion .names span").find((one) => one.textContent === "v").getBoundingClientRect();
    const send = (kind, x, y) => canvas.dispatchEvent(new PointerEvent(kind, { pointerId: 1, clientX: x, clientY: y, bubbles: true }));
    const start = last().coordinates;
    for (const x of [right + 9, left - 9]) {
      const count = asked.length;
      send("pointerdown", x, top + 20);
      send("pointermove", x, top + 21);
      if (asked.length > count) send("pointermove", x, top + 60);
      send("pointerup", x, top + 60);
      await settled();
      if (asked.length > count) break;
    }
    say({ edits, edited, pasted, separated, visited, start, dragged: last().coordinates, label: find("label").textContent });
  })();)",
      1200, fake_worker);
  EXPECT_EQ(
      result.at("edits"),
      nlohmann::json::array(
          {{"free", 0}, {"collides", 1}, {"collides", 3}, {"collides", 3}, {"Decided.", "free"}}));
  const nlohmann::json& edited = result.at("edited");
  EXPECT_EQ(edited.at("coordinates").at(14), -0.125);
  EXPECT_EQ(edited.at("separation"), 0.5);
  EXPECT_EQ(edited.at("norm"), "linf");
  EXPECT_EQ(edited.at("kind"), "edge-edge");
  EXPECT_EQ(result.at("pasted"), "#q=edge_edge,0,0,1,0,0,0,1,0,0,2,0,0,0,0,3,0,0,0,1,0,0,2,0,0");

  EXPECT_EQ(result.at("separated").at(0), "free");
  const nlohmann::json& separated = result.at("separated").at(1);
  EXPECT_EQ(separated.at("kind"), "edge-edge");
  EXPECT_EQ(separated.at("separation"), 0.25);
  EXPECT_EQ(separated.at("norm"), "l2");
  const std::string reason = "The link holds no query: ";
  EXPECT_EQ(result.at("visited"),
            (nlohmann::json{
                "collides", reason + "there are 2 numbers, not the 24 of a query.",
                reason + "the link begins with neither vertex_face nor edge_edge.",
                reason + "the separation is not a finite distance from 0 with norm linf or l2.",
                "free"}));

  // Downwards, as the pointer, at the shown end alone.
  const nlohmann::json &start = result.at("start"), &dragged = result.at("dragged");
  EXPECT_LT(dragged.at(14), start.at(14)) << "no point was grabbed";
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_TRUE(dragged.at(i) == start.at(i) || (12 <= i && i < 15)) << "one point moves: " << i;
  }
  EXPECT_EQ(result.at("label"), "your query");
}

}  // namespace
}  // namespace touchstone::verify::view::view_browser_test
