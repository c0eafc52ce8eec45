// Everything that can be wrong with a scene: the exact place, the message, the remedy.

#include <utility>

#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

struct Wrong {
  std::string inside;  ///< of the scene; its first line is line 2
  std::string place;   ///< without the file
  std::string message;
  std::string remedy;
};

void expect_wrong(const Wrong& wrong) {
  SCOPED_TRACE(wrong.inside);
  expect_problem(problems_in(in_scene(wrong.inside)), "test.xml:" + wrong.place, wrong.message,
                 wrong.remedy);
}

TEST(MitsubaErrors, Elements) {
  expect_wrong(
      {"  <shap type='sphere'/>", "2:3", "unknown element <shap>", "did you mean 'shape'"});
  expect_wrong({"<camera type='perspective'/>", "2:1", "<camera>", "sensor"});
  expect_wrong({"<srgb name='x' value='1'/>", "2:1", "<srgb>", "did you mean 'rgb'"});
  expect_wrong({"<translate x='1'/>", "2:1", "outside of a <transform>", "<translate"});
  expect_wrong({"<scene type='scene'/>", "2:1", "<scene> in an object", "<include>"});
  expect_wrong({"<shape type='s'><float name='x' value='1'><bsdf type='d'/></float></shape>",
                "2:43", "<bsdf> cannot stand in <float>", "'/>'"});
  expect_wrong({"<shape type='s'><transform name='t'>\n<rotat angle='1'/></transform></shape>",
                "3:1", "<rotat> cannot stand in <transform>", "did you mean 'rotate'"});
  expect_wrong(
      {"<shape type='s'><path value='.'/></shape>", "2:17", "<path> in an object", "move"});
}

// Other renderers write elements of their own: these are left out, with all that is in them.
TEST(MitsubaErrors, ForeignElementsAreLeftOut) {
  const std::string text = in_scene(
      "<shape type='sphere'>\n<qmc depth='3'><float name='x' value='no number'/></qmc></shape>\n"
      "<qmc/>\n<hide/>");
  const Description description = parse(text);
  ASSERT_EQ(description.scene->children.size(), 1u);
  EXPECT_TRUE(description.scene->children[0].object->children.empty());
  EXPECT_EQ(description.warnings,
            (std::vector<std::string>{"test.xml:5:1: Kaustik does not know <hide>: it is left out",
                                      "test.xml:3:1: Kaustik does not know <qmc>: it is left out, "
                                      "and 1 more like it"}));
  LoadOptions strict;
  strict.is_strict = true;
  EXPECT_TRUE(parse(in_scene(""), strict).is_strict);
  const auto problems = problems_in(text, strict);
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_EQ(problems[0].message, "unknown element <qmc>");
}

TEST(MitsubaErrors, Attributes) {
  expect_wrong({"<shape/>", "2:1", "<shape> lacks the attribute 'type'", "type="});
  expect_wrong({"<shape typ='sphere'/>", "2:8", "no attribute 'typ'", "did you mean 'type'"});
  expect_wrong({"<shape type='s'\n  type='t'/>", "3:3", "'type' is given twice", "keep one"});
  expect_wrong({"<float name='x'/>", "2:1", "<float> lacks the attribute 'value'", "name="});
  expect_wrong({"<float name='' value='1'/>", "2:1", "without a name", "name"});
  expect_wrong({"<ref name='x'/>", "2:1", "<ref> lacks the attribute 'id'", "id="});
  expect_wrong({"<alias id='x'/>", "2:1", "<alias> lacks the attribute 'as'", "as="});
  expect_wrong({"<default name='' value='1'/>", "2:16", "<default> without a name", "name"});
  expect_wrong({"<point name='p' x='1' y='2'/>", "2:1", "<point> lacks its numbers", "z="});
  expect_wrong({"<point name='p' value='1,2,3' y='2'/>", "2:31", "both 'value' and 'y'", "either"});
  expect_wrong({"<spectrum name='x'/>", "2:1", "either 'value' or 'filename'", "one of the two"});
  expect_wrong({"<spectrum name='x' value='1' filename='f'/>", "2:1",
                "either 'value' or 'filename'", "one of the two"});
  expect_wrong({"<string name='filename' value=''/>", "2:32", "file name is empty", "name a file"});
}

TEST(MitsubaErrors, Numbers) {
  expect_wrong({"<float name='x' value='1,5'/>", "2:24", "'1,5' is not a number", "0.5"});
  expect_wrong({"<float name='x' value=''/>", "2:24", "'' is not a number", "0.5"});
  expect_wrong({"<float name='x' value='nan'/>", "2:24", "not a finite number", "finite"});
  expect_wrong({"<float name='x' value='-inf'/>", "2:24", "not a finite number", "finite"});
  expect_wrong({"<float name='x' value='1e999'/>", "2:24", "out of the range", "1e300"});
  expect_wrong({"<float name='x' value='+-1'/>", "2:24", "'+-1' is not a number", "0.5"});
  expect_wrong({"<integer name='x' value='1.5'/>", "2:26", "'1.5' is not an integer", "<float>"});
  expect_wrong(
      {"<integer name='x' value='99999999999999999999'/>", "2:26", "out of the range", "64 bits"});
  expect_wrong({"<boolean name='x' value='yes'/>", "2:26", "'yes' is not a boolean", "true"});
  expect_wrong({"<point name='x' value='1,2'/>", "2:24", "2 values instead of 3", "x, y and z"});
  expect_wrong({"<point name='x' x='1' y='b' z='1'/>", "2:26", "'b' is not a number", "0.5"});
  const std::string long_text(1000, 'x');
  const auto problems = problems_in(in_scene("<float name='x' value='" + long_text + "'/>"));
  EXPECT_LT(problems.at(0).message.size(), 120u);
}

TEST(MitsubaErrors, Colors) {
  expect_wrong({"<rgb name='x' value='1 2'/>", "2:22", "2 values, a colour has 3 or 1", "blue"});
  expect_wrong({"<rgb name='x' value='#12345'/>", "2:22", "'#12345' is not a colour", "six"});
  expect_wrong({"<rgb name='x' value='#12345g'/>", "2:22", "is not a colour", "six"});
  expect_wrong({"<rgb name='x' value='1 2 c'/>", "2:22", "'c' is not a number", "0.5"});
  expect_wrong({"<spectrum name='x' value=''/>", "2:27", "spectrum is empty", "400:0.1"});
  expect_wrong({"<spectrum name='x' value='1 2 3'/>", "2:27", "three numbers, not", "<rgb>"});
  expect_wrong({"<spectrum name='x' value='1 2'/>", "2:27", "not a pair", "<rgb>"});
  expect_wrong({"<spectrum name='x' value='#ff0000'/>", "2:27", "a colour, not", "<rgb>"});
  expect_wrong({"<spectrum name='x' value='0.4:1, 0.7:2'/>", "2:27", "end at 0.7 nm",
                "a micrometre has 1000"});
  expect_wrong({"<spectrum name='x' value='400:1, 400:2'/>", "2:27", "wavelength 400 follows 400",
                "increasing"});
  expect_wrong({"<spectrum name='x' value='-4:1'/>", "2:27", "wavelength -4 is not", "nanometres"});
  expect_wrong({"<spectrum name='x' value='400:a'/>", "2:27", "'a' is not a number", "0.5"});
  expect_wrong({"<spectrum name='x' value='400:1'/>", "2:27", "of one wavelength", "360:0.5"});
  expect_wrong({"<blackbody name='x'/>", "2:1", "<blackbody> lacks the attribute 'temperature'",
                "temperature="});
  expect_wrong({"<blackbody name='x' temperature='hot'/>", "2:34", "'hot' is not a number", "0.5"});
}

TEST(MitsubaErrors, TransformsThatCollapse) {
  LoadOptions strict;
  strict.is_strict = true;
  for (const auto& [operation, message] :
       {std::pair("<scale value='0'/>", "<scale>: matrix is singular"),
        std::pair("<matrix value='1 0 0 0 1 0 0 0 0'/>", "matrix is singular"),
        std::pair("<rotate x='0' angle='90'/>", "rotation axis is zero")})
    expect_problem(problems_in(in_scene("<shape type='s'><transform name='t'>" +
                                        std::string(operation) + "</transform></shape>"),
                               strict),
                   "test.xml:2:37", message, "invertible");
  // A projection is no place to flatten things.
  expect_wrong(
      {"<shape type='s'><transform name='t'><scale value='1, 1, 0'/>\n<matrix value='1 0 0 0 "
       "0 1 0 0 0 0 1 0 1 0 0 1'/></transform></shape>",
       "3:1", "the transform cannot be", "beside a projection"});
}

TEST(MitsubaErrors, Transforms) {
  const auto expect = [](const std::string& operation, const std::string& column,
                         const std::string& message, const std::string& remedy) {
    expect_wrong(
        {"<transform name='t'>\n" + operation + "</transform>", "3:" + column, message, remedy});
  };
  expect("<translate/>", "1", "<translate> lacks its numbers", "x=");
  expect("<rotate angle='90'/>", "1", "<rotate> lacks its numbers", "x=");
  expect("<rotate x='1'/>", "1", "<rotate> lacks the attribute 'angle'", "angle=");
  expect("<rotate x='1' angle='9o'/>", "22", "'9o' is not a number", "0.5");
  expect("<matrix value='1 2 3'/>", "16", "the matrix has 3 values", "16 values");
  expect("<lookat origin='1,1,1' target='1,1,1'/>", "1", "origin and target are equal",
         "must differ");
  expect("<lookat origin='1,1,1' target='1,2,1' up='0,1,0'/>", "1", "up vector",
         "up must not point");
  expect("<lookat target='1,2,1' up='0,1,0'/>", "1", "lacks the attribute 'origin'", "target=");
  expect("<scale value='1e200'/><scale value='1e200'/>", "23", "not finite", "usual size");
}

TEST(MitsubaErrors, NamesGivenTwice) {
  expect_wrong({"<shape type='s'><float name='r' value='1'/>\n<float name='r' value='2'/></shape>",
                "3:1", "'r' is given twice", "the first is at test.xml:2:17"});
  expect_wrong({"<bsdf type='s'><float name='r' value='1'/>\n<texture type='t' name='r'/></bsdf>",
                "3:1", "'r' is given twice", "the first is at test.xml:2:16"});
  // Of old files the last holds, but a texture and a number are two things.
  const auto problems = problems_in(in_scene(
      "<bsdf type='s'><texture type='t' name='intIOR'/><float name='int_ior' value='1'/></bsdf>",
      "0.6.0"));
  expect_problem(problems, "test.xml:2:49", "'int_ior' is given twice", "test.xml:2:16");
}

TEST(MitsubaErrors, OldTexturePlacementWithoutSize) {
  const Description description =
      parse(in_scene("<texture type='bitmap'><float name='uscale' value='0'/></texture>", "0.6.0"));
  const auto& to_uv = value<Transform>(*description.scene->children.at(0).object, "to_uv");
  EXPECT_EQ(to_uv.dimensions(), 2);
  EXPECT_EQ(to_uv.at(0, 0), 0);
  EXPECT_EQ(to_uv.at(1, 1), 1);
}

TEST(MitsubaErrors, Ids) {
  expect_wrong({"<bsdf type='a' id='white'/>\n <bsdf type='b' id='white'/>", "3:2",
                "the id 'white' is taken", "the first is at test.xml:2:1"});
  expect_wrong({"<bsdf type='a' id='white'/><bsdf type='a' id='black'/>\n<ref id='whit'/>", "3:1",
                "no object has the id 'whit'", "did you mean 'white'"});
  expect_wrong({"<ref id='white'/>", "2:1", "no object has the id 'white'", "no object"});
  expect_wrong({"<bsdf type='a' id='white'/><alias id='whit' as='x'/>", "2:28",
                "no object has the id 'whit'", "did you mean 'white'"});
  expect_wrong({"<bsdf type='a' id='white'/>\n<alias id='white' as='white'/>", "3:1",
                "the id 'white' is taken", "test.xml:2:1"});
}

TEST(MitsubaErrors, CircularReferences) {
  expect_wrong({"<bsdf type='a' id='one'><ref id='one'/></bsdf>", "2:25",
                "circular reference: 'one' → 'one'", "remove"});
  expect_wrong(
      {"<bsdf type='a' id='one'><bsdf type='x'><ref id='two'/></bsdf></bsdf>\n"
       "<bsdf type='b' id='two'><ref id='one'/></bsdf>",
       "3:25", "'one' → <bsdf> → 'two' → 'one'", "remove"});
  expect_wrong(
      {"<shape type='s'><ref id='in'/></shape>\n"
       "<bsdf type='a' id='out'><bsdf type='x' id='in'><ref id='out'/></bsdf></bsdf>",
       "3:48", "'in' → 'out' → 'in'", "remove"});
  expect_wrong({"<alias id='a' as='b'/>\n<alias id='b' as='a'/>", "3:1",
                "the alias 'a' stands for itself, by way of 'b'", "name an object"});
  expect_wrong({"<alias id='a' as='a'/>", "2:1", "the alias 'a' stands for itself", "an object"});
  expect_wrong({"<alias id='b' as='a'/>\n<ref id='a'/>\n<alias id='a' as='b'/>", "2:1",
                "the alias 'a' stands for itself, by way of 'b'", "name an object"});
}

std::string nested(int levels, const std::string& innermost) {
  std::string text;
  for (int i = 0; i < levels; ++i) text += "<bsdf type='b'>";
  text += innermost;
  for (int i = 0; i < levels; ++i) text += "</bsdf>";
  return text;
}

TEST(MitsubaErrors, Depth) {
  EXPECT_NO_THROW(parse_inside(nested(99, "")));
  // 15 letters per level: the element after the 99th below the scene.
  expect_wrong({nested(100, ""), "2:1486", "nest more than 100 levels", "flatter"});
  EXPECT_NO_THROW(parse_inside(nested(50, "<ref id='x'/>") + "<bsdf type='b' id='x'>" +
                               nested(48, "") + "</bsdf>"));
  expect_wrong(
      {nested(50, "<ref id='x'/>") + "\n<bsdf type='b' id='x'>" + nested(49, "") + "</bsdf>",
       "2:751", "nest more than 100 levels", "flatter"});
  const auto problems = problems_in(in_scene(nested(200000, "")));
  EXPECT_NE(problems.at(0).message.find("nest more than 100 levels"), std::string::npos);
}

TEST(MitsubaErrors, LongChainsOfReferences) {
  std::string text;
  for (int i = 0; i < 20000; ++i)
    text += "<bsdf type='b' id='n" + std::to_string(i) + "'><ref id='n" + std::to_string(i + 1) +
            "'/></bsdf>\n";
  text += "<bsdf type='b' id='n20000'/>";
  const auto problems = problems_in(in_scene(text));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("nest more than 100 levels"), std::string::npos);
}

TEST(MitsubaErrors, BrokenXml) {
  const auto expect = [](const std::string& text, const std::string& place,
                         const std::string& message, const std::string& remedy) {
    SCOPED_TRACE(text);
    expect_problem(problems_in(text), "test.xml:" + place, message, remedy);
  };
  expect("<scene version='3.0.0'>\n <shape type='a'>\n <!-- </x> -->\n</scene>", "4:3",
         "tags mismatch", "<shape> of line 2 is still open");
  expect("<scene version='3.0.0'>\n <shape type='a/>", "2:15", "broken XML", "&lt;");
  expect("<scene version='3.0.0'>\n <shape type=a/></scene>", "2:14", "broken XML", "&lt;");
  expect("<scene version='3.0.0'>\n <1/></scene>", "2:3", "broken XML", "&lt;");
  expect("<scene version='3.0.0'>\n", "1:24", "tags mismatch", "<scene> of line 1 is still open");
  expect("<scene version='3.0.0'/>\n</scene>", "2:3", "tags mismatch", "no element is open");
  expect("<scene version='3.0.0'/>\n  <scene/>", "2:3", "second root", "one <scene>");
  expect("<scene version='3.0.0'/>\n  abc", "2:3", "text outside the root", "<scene version");
  // What does not even begin as a scene may be any file: no column, so that nothing is quoted.
  expect("", "1", "no XML element", "<scene version");
  expect("<!-- only a comment -->", "1", "no XML element", "<scene version");
  expect("ply\nformat ascii 1.0\n", "1", "text outside the root", "<scene version");
}

TEST(MitsubaErrors, Encoding) {
  using namespace std::string_literals;
  const auto expect = [](const std::string& text, const std::string& place,
                         const std::string& message) {
    expect_problem(problems_in(text), "test.xml:" + place, message, "UTF-8");
  };
  expect("<scene version='3.0.0'>\n<!-- \xe4 --></scene>", "2:6", "not UTF-8");
  expect("<scene version='3.0.0'>\n<!-- \xc0\x80 --></scene>", "2:6", "not UTF-8");
  expect("<scene version='3.0.0'>\n<!-- \xed\xa0\x80 --></scene>", "2:6", "not UTF-8");
  expect("<scene version='3.0.0'>\n<!-- \xf4\x90\x80\x80 --></scene>", "2:6", "not UTF-8");
  expect("<scene version='3.0.0'/>\n\xe2\x82", "2:1", "not UTF-8");
  expect("<scene version='3.0.0'/>\n\0"s, "2:1", "zero byte");
  expect("\xff\xfe<\0"s, "1", "UTF-16");
  EXPECT_NO_THROW(parse("<scene version='3.0.0'><!-- ä € 😀 --></scene>"));
}

TEST(MitsubaErrors, Versions) {
  LoadOptions strict;
  strict.is_strict = true;
  expect_problem(problems_in("\n<scene/>", strict), "test.xml:2:1", "<scene> lacks its version",
                 "3.0.0");
  expect_problem(problems_in("\n<config/>"), "test.xml:2", "<config> lacks its version", "3.0.0");
  for (const std::string version : {"", "x", "3.0.0.0", "3.-1.0", "3..0", "3.0.", "3.0.0x"}) {
    SCOPED_TRACE(version);
    expect_problem(problems_in(in_scene("", version)), "test.xml:1:17", "is not a version",
                   "three numbers");
  }
  expect_problem(problems_in("<bsdf version='3.0.0' type='diffuse'/>"), "test.xml:1:1",
                 "the root element is <bsdf>", "<scene");
}

TEST(MitsubaErrors, Definitions) {
  expect_wrong(
      {"<float name='x' value='$spp'/>", "2:24", "$spp is not defined", "define it: spp="});
  expect_wrong({"<default name='spp' value='1'/><float name='x' value='$sp'/>", "2:55",
                "$sp is not defined", "did you mean 'spp'"});
  expect_wrong({"<float name='x' value='a$'/>", "2:24", "'$' without a name", "\\$"});
  expect_wrong({"<default name='r' value='abc'/><float name='x' value='$r'/>", "2:55",
                "'abc' is not a number, which comes from '$r'", "0.5"});
  const std::string text = in_scene("<default name='spp' value='1'/>");
  const auto expect = [](const std::string& scene, const LoadOptions& options,
                         const std::string& message, const std::string& remedy) {
    expect_problem(problems_in(scene, options), "definitions", message, remedy);
  };
  expect(text, {{{"sp", "2"}}}, "does not use 'sp'", "did you mean 'spp'? Valid: spp");
  expect(in_scene(""), {{{"sp", "2"}}}, "does not use 'sp'", "no <default>");
  expect(text, {{{"spp", "2"}, {"spp", "3"}}}, "'spp' is defined twice", "keep one");
  expect(text, {{{"", "2"}}}, "cannot be the name", "letters");
  expect(text, {{{"a b", "2"}}}, "cannot be the name", "letters");
}

TEST(MitsubaErrors, DefinitionsThatGrowWithoutBounds) {
  std::string text = "<default name='a0' value='" + std::string(1000, 'x') + "'/>\n";
  for (int i = 1; i < 20; ++i) {
    const std::string use = "$a" + std::to_string(i - 1) + ",";
    text += "<default name='a" + std::to_string(i) + "' value='";
    for (int j = 0; j < 10; ++j) text += use;
    text += "'/>\n";
  }
  const auto problems = problems_in(in_scene(text));
  EXPECT_NE(problems.at(0).message.find("more than 64 MiB"), std::string::npos);
}

TEST(MitsubaErrors, SeveralAreToldAtOnce) {
  const auto problems = problems_in(
      in_scene("<shape type='a'><float name='x' value='b'/></shape>\n<float name='y' value='c'/>\n"
               "<ref id='nothing'/>"));
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_EQ(text_of(problems[0].place), "test.xml:2:40");
  EXPECT_EQ(text_of(problems[1].place), "test.xml:3:24");
  EXPECT_EQ(text_of(problems[2].place), "test.xml:4:1");
  std::string many;
  for (int i = 0; i < 100; ++i) many += "<bsdff/>\n";
  EXPECT_EQ(problems_in(in_scene(many)).size(), Problems::maximum);
}

TEST(MitsubaErrors, FollowUpErrorsAreNotTold) {
  // The unknown element might have held the object and the use of the definition.
  const auto problems =
      problems_in(in_scene("<bsdff id='white'/><ref id='white'/>"), {{{"a", "1"}}});
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("<bsdff>"), std::string::npos);
}

TEST(MitsubaErrors, Files) {
  const TemporaryFolder folder;
  const auto load = [&](const std::string& path) {
    return problems_of([&] { load_mitsuba_xml(path); });
  };
  expect_problem(load(folder / "no.xml"), folder / "no.xml", "No such file", "name");
  expect_problem(load(folder / ""), folder / "", "not a regular file", "file");
  const std::string empty = folder.write("empty.xml", "");
  expect_problem(load(empty), empty + ":1", "no XML element", "<scene");
  const std::string huge = folder.write("huge.xml", "<scene version='3.0.0'/>");
  std::filesystem::resize_file(huge, uint64_t{3} << 30);
  expect_problem(load(huge), huge + "", "more than 512 MiB", "PLY");
}

TEST(MitsubaErrors, NamedFiles) {
  const TemporaryFolder folder;
  folder.write("bad.spd", "400 1\n\n500 1 2\n");
  folder.write("empty.spd", "# nothing\n");
  const auto expect = [&](const std::string& element, const std::string& place,
                          const std::string& message) {
    const std::string path = folder.write("scene.xml", in_scene(element));
    expect_problem(problems_of([&] { load_mitsuba_xml(path); }), folder / place, message, "");
  };
  expect("<spectrum name='x' filename='no.spd'/>", "scene.xml:2:30", "No such file");
  expect("<spectrum name='x' filename='bad.spd'/>", "bad.spd:3", "not two numbers");
  expect("<spectrum name='x' filename='empty.spd'/>", "empty.spd", "spectrum is empty");
  expect("<include filename='no.xml'/>", "scene.xml:2:20", "No such file");
  expect("<include filenam='no.xml'/>", "scene.xml:2:10", "no attribute 'filenam'");
  const std::string path = folder.write("scene.xml", in_scene("<path value='no'/>"));
  EXPECT_NE(load_mitsuba_xml(path).warnings.at(0).find("there is no folder"), std::string::npos);
  LoadOptions strict;
  strict.is_strict = true;
  expect_problem(problems_of([&] { load_mitsuba_xml(path, strict); }), path + ":2:14",
                 "there is no folder", "");
}

TEST(MitsubaErrors, Includes) {
  const TemporaryFolder folder;
  folder.write("broken.xml", "<scene version='3.0.0'>\n<a></scene>");
  folder.write("unversioned.xml", "<bsdf type='diffuse'/>");
  folder.write("float.xml", "<float version='3.0.0' name='x' value='1'/>");
  folder.write("bad.xml", in_scene("\n<float name='x' value='y'/>"));
  folder.write("twin.xml", in_scene("<bsdf type='b' id='white'/>"));
  const auto expect = [&](const std::string& inside, const std::string& place,
                          const std::string& message, const std::string& remedy) {
    const std::string path = folder.write("scene.xml", in_scene(inside));
    expect_problem(problems_of([&] { load_mitsuba_xml(path); }), folder / place, message, remedy);
  };
  expect("<include filename='broken.xml'/>", "broken.xml:2:6", "mismatch", "<a> of line 2");
  const std::string path = folder.write("s.xml", in_scene("<include filename='unversioned.xml'/>"));
  const Description description = load_mitsuba_xml(path);
  ASSERT_EQ(description.warnings.size(), 1u);
  EXPECT_NE(description.warnings[0].find("as one of the file that includes it"), std::string::npos);
  LoadOptions strict;
  strict.is_strict = true;
  expect_problem(problems_of([&] { load_mitsuba_xml(path, strict); }), folder / "unversioned.xml:1",
                 "lacks its version", "3.0");
  expect("<include filename='float.xml'/>", "scene.xml:2:20", "float.xml' is no part of a scene",
         "root is <scene");
  expect("<include filename='bad.xml'/>", "bad.xml:3:24", "'y' is not a number", "");
  expect("<bsdf type='b' id='white'/><include filename='twin.xml'/>", "twin.xml:2:1",
         "the id 'white' is taken", "scene.xml:2:1");
}

TEST(MitsubaErrors, CircularIncludes) {
  const TemporaryFolder folder;
  folder.write("sub/b.xml", in_scene("<include filename='../a.xml'/>"));
  const std::string a = folder.write("a.xml", in_scene("\n  <include filename='sub/b.xml'/>"));
  const auto problems = problems_of([&] { load_mitsuba_xml(a); });
  const std::string b = folder / "sub/b.xml";
  expect_problem(problems, b + ":2:20",
                 "circular <include>: " + a + " → " + b + " → " + (folder / "sub/../a.xml"),
                 "remove");
}

TEST(MitsubaErrors, ChainsAndBombsOfIncludes) {
  const TemporaryFolder folder;
  // Each file includes the next one twice: 2^n files in all.
  for (int i = 0; i < 20; ++i) {
    const std::string next = "<include filename='" + std::to_string(i + 1) + ".xml'/>";
    folder.write(std::to_string(i) + ".xml", in_scene(next + next));
  }
  const std::string first = folder / "0.xml";
  const auto chain = problems_of([&] { load_mitsuba_xml(first); });
  EXPECT_NE(chain.at(0).message.find("nest more than 15 files"), std::string::npos);
  folder.write("13.xml", in_scene(""));
  const auto bomb = problems_of([&] { load_mitsuba_xml(first); });
  EXPECT_NE(bomb.at(0).message.find("more than 10000 files"), std::string::npos);
}

}  // namespace
}  // namespace kaustik
