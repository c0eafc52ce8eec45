// Files that strangers made: what they cost is in proportion to their size, and what they name is
// not shown. Times are bounded loosely; what was quadratic took a hundred times as long.

#include <fmt/format.h>

#include <ctime>

#include "kaustik/loader/mitsuba_reader.h"
#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int thousands = 3;
constexpr double seconds = 10;
#else
constexpr int thousands = 30;
constexpr double seconds = 3;
#endif

/// `count` elements from their numbers.
template <typename Element>
std::string many(int count, const Element& element) {
  std::string text;
  for (int i = 0; i < count; ++i) text += element(i);
  return text;
}

/// Runs `work`, which must not take long.
template <typename Work>
auto in_time(const Work& work) {
  struct Clock {
    std::clock_t start = std::clock();  // of the processor: others may use the machine, too
    ~Clock() { EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, seconds); }
  } clock;
  return work();
}

TEST(MitsubaLimits, ChainsOfAliases) {
  const int count = thousands * 1000;
  const auto link = [](int i) { return fmt::format("<alias id='b{}' as='b{}'/>\n", i, i + 1); };
  const std::string chain = "<bsdf type='diffuse' id='b0'/>" + many(count, link);
  const std::string use = fmt::format("<shape type='sphere'><ref id='b{}'/></shape>", count);
  const auto scene = in_time([&] { return parse_inside(chain + use).scene; });
  EXPECT_EQ(scene->children.at(1).object->children.at(0).object, scene->children.at(0).object);
  // The last names the first: nothing that the message may suggest.
  const auto circle = in_time([&] {
    return problems_in(
        in_scene(many(count, link) + fmt::format("<alias id='b{}' as='b0'/>", count)));
  });
  EXPECT_EQ(circle.size(), 1u);
  EXPECT_NE(circle[0].message.find("stands for itself, by way of"), std::string::npos);
}

TEST(MitsubaLimits, AliasesThatLeadNowhereAreToldByTheirEnd) {
  const auto problems =
      problems_in(in_scene("<bsdf type='diffuse' id='wood'/>\n<alias id='woood' as='a'/>\n"
                           "<alias id='a' as='b'/>\n<shape type='sphere'><ref id='b'/></shape>"));
  expect_problem(problems, "test.xml:3:1", "no object has the id 'woood'", "did you mean 'wood'?");
}

TEST(MitsubaLimits, Definitions) {
  const int count = thousands * 1000;
  const std::string defaults = many(count, [](int i) {
    return fmt::format("<default name='d{}' value='{}'/>", i,
                       i == 0 ? "7" : fmt::format("$d{}", i - 1));
  });
  const std::string use =
      fmt::format("<shape type='sphere'><float name='x' value='$d{}'/></shape>", count - 1);
  const auto scene = in_time([&] { return parse_inside(defaults + use).scene; });
  EXPECT_EQ(value<double>(*scene->children.at(0).object, "x"), 7);
  LoadOptions options;
  for (int i = 0; i < count; ++i) options.definitions.emplace_back(fmt::format("d{}", i), "7");
  in_time([&] { return parse_inside(defaults, options).scene; });
  // Each of those that nothing uses is compared with all names that there are.
  const std::string others = many(
      count, [](int i) { return fmt::format("<default name='name_number_{}' value='1'/>", i); });
  EXPECT_EQ(in_time([&] { return problems_in(in_scene(others), options); }).size(),
            Problems::maximum);
  EXPECT_NE(problems_in(in_scene("<default name='a$b' value='1'/>")).at(0).message.find("$a"), 0u);
  const auto longer =
      problems_in(in_scene("<default name='" + std::string(300, 'a') + "' value='1'/>"));
  expect_problem(longer, "test.xml:2:16", "cannot be the name of a <default>", "200");
}

TEST(MitsubaLimits, TheLongestNameThatFits) {
  const auto value_of = [](const std::string& text) {
    const auto scene = parse_inside(
                           "<default name='a' value='1'/><default name='ab' value='2'/>"
                           "<default name='abcd' value='4'/><shape type='sphere'>"
                           "<string name='x' value='" +
                           text + "'/></shape>")
                           .scene;
    return value<std::string>(*scene->children.at(0).object, "x");
  };
  EXPECT_EQ(value_of("$a"), "1");
  EXPECT_EQ(value_of("$abc"), "2c");
  EXPECT_EQ(value_of("$abcde$a$ab"), "4e12");
  EXPECT_EQ(value_of("$a\\$b"), "1$b");
}

TEST(MitsubaLimits, UnknownIdsAmongMany) {
  const std::string ids = many(thousands * 1000, [](int i) {
    return fmt::format("<bsdf type='diffuse' id='a material with a long name {:08}'/>", i);
  });
  const std::string uses = many(
      15, [](int i) { return fmt::format("<ref id='A Material with another name {:08}'/>", i); });
  EXPECT_EQ(in_time([&] { return problems_in(in_scene(ids + uses)); }).size(), 15u);
}

TEST(MitsubaLimits, SearchedFolders) {
  const std::string same = many(thousands * 1000, [](int) { return "<path value='.'/>"; });
  in_time([&] { return parse_inside(same); });
  const TemporaryFolder folder;
  std::string many_folders;
  for (int i = 0; i < 60; ++i) {
    folder.write(fmt::format("f{}/x", i), "");
    many_folders += fmt::format("<path value='{}'/>", folder / fmt::format("f{}", i));
  }
  const auto problems = problems_in(in_scene(many_folders));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("more than 50 folders"), std::string::npos);
}

TEST(MitsubaLimits, FilesThatAreIncludedAgainAndAgain) {
  const TemporaryFolder folder;
  folder.write("objects.xml", in_scene(many(2000, [](int) { return "<bsdf type='diffuse'/>"; })));
  folder.write("defaults.xml", in_scene(many(2000, [](int i) {
                 return fmt::format("<default name='d{}' value='1'/>", i);
               })));
  folder.write("tree.xml",
               in_scene(many(90, [](int) { return "<include filename='objects.xml'/>"; })));
  folder.write("curve.spd", many(100000, [](int i) { return fmt::format("{} 0.5\n", i + 1); }));
  for (const std::string element :
       {"<include filename='objects.xml'/>", "<include filename='defaults.xml'/>",
        "<include filename='tree.xml'/>",
        "<bsdf type='diffuse'><spectrum name='x' filename='curve.spd'/></bsdf>"}) {
    SCOPED_TRACE(element);
    const std::string path =
        folder.write("scene.xml", in_scene(many(9000, [&](int) { return element; })));
    mitsuba::Reader reader({});
    const auto problems = problems_of([&] { reader.read_file(path); });
    // Each file is read once, and of what is in them no more is made than the limit allows.
    EXPECT_LE(reader.counts().files, 3u);
    EXPECT_LT(reader.counts().elements, 800'000u);
    EXPECT_NE(problems.at(0).message.find("includes the same files so often"), std::string::npos)
        << problems[0].message;
  }
  // Once each is in proportion, whatever they hold.
  const std::string once = folder.write(
      "scene.xml", in_scene("<include filename='objects.xml'/><include filename='objects.xml'/>"));
  EXPECT_EQ(load_mitsuba_xml(once).scene->children.size(), 4000u);
}

TEST(MitsubaLimits, MoreElementsThanAnythingElseAreNoReasonToRefuse) {
  // As many elements in a megabyte as there can be: the limit is for what multiplies.
  const std::string most =
      "<bsdf type='null' id='a'/>" + many(thousands * 1000, [](int) { return "<ref id='a'/>"; });
  EXPECT_EQ(parse_inside(most).scene->children.size(), size_t(thousands * 1000 + 1));
}

/// All that the user sees of an error.
std::string complaint(const std::string& path) {
  try {
    load_mitsuba_xml(path);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(MitsubaLimits, NothingOfAFileThatIsNoSceneIsQuoted) {
  const TemporaryFolder folder;
  const std::string secret = "hunter2";
  const std::vector<std::string> secrets = {
      secret + ":x:0:0:root\n",
      "x " + secret + "\n",
      "1 " + secret + "\n",
      "<" + secret + ">\n",
      "<config version='1.0.0'><key>" + secret + "</key></config>",
      "<a><" + secret + "></a>",
      "<?xml version='1.0'?><a b='" + secret + "'",
      "<!-- " + secret,
      "<film>" + secret + "</film>",
      "# " + secret + "\n500 " + secret,
      secret + std::string(1, '\0'),
      "\xff\xfe" + secret};
  for (const std::string& text : secrets) {
    folder.write("secret", text);
    for (const std::string element :
         {"<include filename='secret'/>",
          "<bsdf type='diffuse'><spectrum name='reflectance' filename='secret'/></bsdf>"}) {
      SCOPED_TRACE(text + element);
      const std::string told = complaint(folder.write("scene.xml", in_scene(element)));
      EXPECT_NE(told, "");
      EXPECT_EQ(told.find(secret), std::string::npos) << told;
    }
    EXPECT_EQ(complaint(folder / "secret").find(secret), std::string::npos)
        << complaint(folder / "secret");
  }
  // A part of a scene is shown, so that it can be mended.
  folder.write("part.xml",
               in_scene("<shape type='sphere'><float name='radius' value='r2'/></shape>"));
  const std::string told =
      complaint(folder.write("scene.xml", in_scene("<include filename='part.xml'/>")));
  EXPECT_NE(told.find("\n    <shape type='sphere'><float name='radius' value='r2'/>"),
            std::string::npos)
      << told;
}

}  // namespace
}  // namespace kaustik
