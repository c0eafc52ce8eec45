// Entities: what they stand for, where problems in them are told, and that they stay small.

#include <fmt/format.h>

#include <ctime>

#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

/// A scene with these declarations; what is inside begins at line 3.
std::string declaring(const std::string& declarations, const std::string& inside) {
  return "<!DOCTYPE scene [" + declarations + "]>\n" + in_scene(inside);
}

const Object& first_shape(const Description& description) {
  return *description.scene->children.at(0).object;
}

TEST(XmlEntities, StandForTextInValuesAndBetweenElements) {
  const Description description = parse(
      declaring("<!ENTITY r '2'> <!ENTITY big \"&r;0\"> <!-- ' > --> <!ENTITY r '7'>\n"
                "<!ELEMENT scene ANY> <!ENTITY radius '<float name=\"radius\" value=\"&big;\"/>'>",
                "<shape type='sphere'>&radius;<string name='a' value='&lt;&r;&amp;r;'/></shape>"));
  EXPECT_EQ(value<double>(first_shape(description), "radius"), 20);  // of two the first holds
  EXPECT_EQ(value<std::string>(first_shape(description), "a"), "<2&r;");
}

TEST(XmlEntities, QuotesInThemEndNoValue) {
  const Description description =
      parse(declaring("<!ENTITY both '\"&one;\"'><!ENTITY one \"'\">",
                      "<shape type='sphere'><string name='a' value=\"&both;x\"/>"
                      "<string name='b' value='&both;&one;'/></shape>"));
  EXPECT_EQ(value<std::string>(first_shape(description), "a"), "\"'\"x");
  EXPECT_EQ(value<std::string>(first_shape(description), "b"), "\"'\"'");
}

TEST(XmlEntities, StayWhereTheyMeanNothing) {
  const std::string shape =
      "<shape type='sphere'><!-- &a; --><string name='x' value='&a;'/><![CDATA[ &a; ]]></shape>";
  EXPECT_EQ(value<std::string>(first_shape(parse(in_scene(shape))), "x"), "&a;");
  EXPECT_EQ(value<std::string>(first_shape(parse("<!DOCTYPE scene>" + in_scene(shape))), "x"),
            "&a;");
  // In comments and CDATA also where it is declared: as a file it could not be read.
  const std::string declared = declaring("<!ENTITY a SYSTEM 'no.xml'><!ENTITY b '1'>",
                                         "<!-- &a; --><?x &a; ?><shape type='sphere'>"
                                         "<float name='x' value='&b;'/><![CDATA[ &a; ]]></shape>");
  EXPECT_EQ(value<double>(first_shape(parse(declared)), "x"), 1);
}

TEST(XmlEntities, WithoutADeclarationAreTold) {
  const std::vector<std::string> warnings =
      parse(in_scene("&header;<shape type='sphere'/>")).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("an entity that no DOCTYPE declares is left out"), std::string::npos)
      << warnings[0];
}

TEST(XmlEntities, FilesBesideTheScene) {
  const TemporaryFolder folder;
  folder.write("parts/header.xml",
               "\xef\xbb\xbf<?xml version='1.0' encoding='utf-8'?>\n"
               "<bsdf type='diffuse' id='white'/>\n<shape type='sphere'>&r;</shape>\n");
  const std::string scene = folder.write(
      "scene.xml", declaring("<!ENTITY header SYSTEM 'parts\\header.xml'>"
                             "<!ENTITY same PUBLIC '-//x//y' \"file://" +
                                 (folder / "parts/header.xml") +
                                 "\"><!ENTITY r '<float name=\"radius\" value=\"3\"/>'>",
                             "&header;\n<shape type='sphere'><ref id='white'/></shape>"));
  const Description description = load_mitsuba_xml(scene);
  ASSERT_EQ(description.scene->children.size(), 3u);
  EXPECT_EQ(value<double>(*description.scene->children[1].object, "radius"), 3);
  EXPECT_EQ(description.sources.size(), 2u);
  // A document that is included has its own.
  folder.write("outer.xml", in_scene("<include filename='scene.xml'/>"));
  EXPECT_EQ(load_mitsuba_xml(folder / "outer.xml").scene->children.size(), 3u);
}

TEST(XmlEntities, ProblemsAreToldWhereTheyAreWritten) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& declarations, const std::string& inside,
                          const std::string& place, const std::string& message,
                          const std::string& remedy) {
    SCOPED_TRACE(message);
    const std::string scene = folder.write("scene.xml", declaring(declarations, inside));
    expect_problem(problems_of([&] { load_mitsuba_xml(scene); }), folder / place, message, remedy);
  };
  const std::string header = "<!ENTITY header SYSTEM 'header.xml'>";
  folder.write(
      "header.xml",
      "<?xml version='1.0'?>\n<shape type='sphere'>\n <float name='r' value='x'/></shape>");
  expect(header, "\n&header;", "header.xml:3:25", "'x' is not a number", "");
  // Behind what an entity stands for, and within its declaration.
  folder.write("header.xml", "<bsdf type='a'/>\n\n");
  expect(header, "&header; <shape type='sphere'><float name='r' value='y'/></shape>",
         "scene.xml:3:54", "'y' is not a number", "");
  expect("\n <!ENTITY part '<shape type=\"a\"><float name=\"r\" value=\"z\"/></shape>'>", "&part;",
         "scene.xml:2:56", "'z' is not a number", "");
  // Broken XML.
  folder.write("header.xml", "<bsdf type='a'>\n<float name='r' value='1'>\n");
  expect(header, "\n&header;\n</scene>", "scene.xml:5:3", "mismatch",
         "<float> of line 2 of " + (folder / "header.xml"));
  folder.write("header.xml", "<bsdf type='\xff'/>");
  expect(header, "&header;", "header.xml:1:13", "not UTF-8", "save the file as UTF-8");
}

TEST(XmlEntities, WhatCannotBe) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& declarations, const std::string& inside,
                          const std::string& place, const std::string& message,
                          const std::string& remedy) {
    SCOPED_TRACE(message);
    const std::string scene = folder.write("scene.xml", declaring(declarations, inside));
    expect_problem(problems_of([&] { load_mitsuba_xml(scene); }), scene + ":" + place, message,
                   remedy);
  };
  const std::string a = "<!ENTITY a '1'>";
  expect(a + "<!ENTITY header ''>", "\n&heaeder;", "4:1", "declares no entity 'heaeder'",
         "did you mean 'header'?");
  expect(a, "&" + std::string(300, 'b') + ";", "3:1", "does not declare this entity", "&amp;");
  expect("<!ENTITY a '&b;'><!ENTITY b '&a;'>", "&a;", "1:47", "'a' stands within itself", "remove");
  expect("<!ENTITY a SYSTEM 'scene.xml'>", "&a;", "1:37", "which is being read already", "a part");
  expect("<!ENTITY a SYSTEM 'no.xml'>", "&a;", "1:37", "No such file", "");
  expect("<!ENTITY a SYSTEM ''>", "&a;", "1:37", "without a name", "a part");
  expect("<!ENTITY a SYSTEM 'http://x.org/a.xml'>", "&a;", "1:37", "is no file here",
         "beside the scene");
  expect("<!ENTITY a SYSTEM 'b.xml'>", "<bsdf type='&a;'/>", "3:13", "which is a file, stands in",
         "<!ENTITY name \"text\">");
  expect("<!ENTITY % a SYSTEM 'b.dtd'> %a;", "", "1:47", "a parameter entity",
         "in this file itself");
  expect("<!ENTITY 1 '2'>", "", "1:27", "an entity without a name", "<!ENTITY name");
  expect("<!ENTITY a>", "", "1:28", "text in quotes is missing", "<!ENTITY name");
  expect("what", "", "1:18", "something that is no declaration", "<!ENTITY name");
  expect("<!ENTITY a '>", "", "4", "document type declaration", "give a Mitsuba scene");
  // One that no one uses harms nobody.
  const std::string unused = declaring("<!ENTITY a SYSTEM 'no.xml'>", "");
  EXPECT_NO_THROW(parse(unused));
  // Without a folder to look in files are read from where the program runs.
  expect_problem(problems_in(declaring("<!ENTITY a SYSTEM 'no such.xml'>", "&a;")), "test.xml:1:37",
                 "No such file", "");
  // Level by level.
  std::string levels = "<!ENTITY e0 ''>";
  for (int i = 1; i < 20; ++i) levels += fmt::format("<!ENTITY e{} '&e{};'>", i, i - 1);
  EXPECT_NO_THROW(parse(declaring(levels, "&e14;")));
  EXPECT_NE(problems_in(declaring(levels, "&e15;")).at(0).message.find("15 levels deep"),
            std::string::npos);
}

TEST(XmlEntities, FilesThatAreNoPartsOfScenesAreNotShown) {
  const TemporaryFolder folder;
  const std::string scene =
      folder.write("scene.xml", declaring("<!ENTITY a SYSTEM 'secret'>", "&a;"));
  for (const std::string& secret :
       {std::string("hunter2:x:0:0\n"), std::string("<hunter2 a='b'/>"), std::string("<?hunter2?>"),
        std::string("<!DOCTYPE hunter2 [<!ENTITY hunter2 'hunter2'>]>"),
        std::string("hunter2\0", 8), std::string()}) {
    SCOPED_TRACE(secret);
    folder.write("secret", secret);
    const auto problems = problems_of([&] { load_mitsuba_xml(scene); });
    expect_problem(problems, scene + ":1:37", "is no part of a scene", "<bsdf type=");
    EXPECT_EQ(problems[0].message.find("hunter2"), std::string::npos);
  }
  // Nor is what a file that is no scene declares or uses.
  folder.write("secret", "<!DOCTYPE a [<!ENTITY b SYSTEM 'hunter2'>]><a>&b;&hunter2;</a>");
  const std::string includes = folder.write("scene.xml", in_scene("<include filename='secret'/>"));
  const auto problems = problems_of([&] { load_mitsuba_xml(includes); });
  EXPECT_EQ(problems.at(0).message.find("hunter2"), std::string::npos) << problems[0].message;
}

// Entities that hold entities, many of a long one, files again and again: refused before they are
// large.
TEST(XmlEntities, GrowToNothingLarge) {
  std::string laughs = "<!ENTITY e0 'ha'>";
  for (int i = 1; i < 12; ++i) {
    laughs += fmt::format("<!ENTITY e{} '", i);
    for (int k = 0; k < 10; ++k) laughs += fmt::format("&e{};", i - 1);
    laughs += "'>";
  }
  std::string many_uses;
  for (int i = 0; i < 3000; ++i) many_uses += "&long;";
  const std::string long_text = "<!ENTITY long '" + std::string(10000, ' ') + "'>";
  std::string empty = laughs;
  empty.replace(empty.find("'ha'"), 4, "''");
  const TemporaryFolder folder;
  folder.write("long.xml", "<bsdf type='diffuse'/>" + std::string(10000, ' '));
  for (const std::string& text :
       {declaring(laughs, "&e11;"), declaring(laughs, "<bsdf type='&e11;'/>"),
        declaring(empty, "&e11;"), declaring(long_text, many_uses),
        declaring("<!ENTITY long SYSTEM 'long.xml'>", many_uses)}) {
    const std::string scene = folder.write("scene.xml", text);
    const std::clock_t start = std::clock();
    const auto problems = problems_of([&] { load_mitsuba_xml(scene); });
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 10);
    EXPECT_NE(problems.at(0).message.find("more than 16 MiB of text"), std::string::npos)
        << problems[0].message;
  }
  // What all the documents of a scene use counts together.
  folder.write("part.xml", declaring(long_text, many_uses.substr(0, many_uses.size() / 3)));
  const std::string include = "<include filename='part.xml'/>";
  EXPECT_NO_THROW(load_mitsuba_xml(folder.write("scene.xml", in_scene(include))));
  folder.write("other.xml", declaring(long_text, many_uses.substr(0, many_uses.size() / 3)));
  EXPECT_THROW(load_mitsuba_xml(folder.write(
                   "scene.xml", in_scene(include + "<include filename='other.xml'/>"))),
               Error);
}

}  // namespace
}  // namespace kaustik
