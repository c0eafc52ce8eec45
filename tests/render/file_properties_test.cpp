// What the tables call a file, the loader has found in the folder of the scene; and nothing else.

#include <gtest/gtest.h>

#include "kaustik/base/error.h"
#include "kaustik/integrator/description_types.h"
#include "kaustik/loader/mitsuba_xml.h"

namespace kaustik {
namespace {

TEST(FileProperties, AreThoseOfTheTables) {
  int files = 0, texts = 0;
  for (const TypeInfo* info : description_types().all())
    for (const Parameter& row : info->parameters) {
      if (row.kind != ParameterKind::file && row.kind != ParameterKind::text) continue;
      const bool is_file = row.kind == ParameterKind::file;
      ++(is_file ? files : texts);
      const Description description =
          parse_mitsuba_xml("<scene version=\"3.0.0\"><" + info->family + " type=\"" + info->name +
                                "\"><string name=\"" + row.name + "\" value=\"x.bin\"/></" +
                                info->family + "></scene>",
                            "test.xml", "some/folder");
      const Property& property = description.scene->children[0].object->properties[0];
      EXPECT_EQ(std::get<std::string>(property.value), is_file ? "some/folder/x.bin" : "x.bin")
          << info->family << " " << info->name << " " << row.name;
      EXPECT_EQ(named_files(description, description_types()).size(), is_file ? 1u : 0u);
    }
  EXPECT_GE(files, 5);
  EXPECT_GE(texts, 5);
}

}  // namespace
}  // namespace kaustik
