#include "kaustik/loader/mitsuba_xml.h"

#include "kaustik/loader/mitsuba_reader.h"
#include "kaustik/loader/nori_scene.h"
#include "kaustik/loader/xml_scan.h"

namespace kaustik {

bool is_mitsuba_xml(std::string_view head) { return root_tag(head) == "scene" && !is_nori(head); }

Description load_mitsuba_xml(const std::string& path, const LoadOptions& options) {
  return mitsuba::Reader(options).read_file(path);
}

Description parse_mitsuba_xml(std::string_view text, std::string name_for_messages,
                              const std::string& base_folder, const LoadOptions& options) {
  return mitsuba::Reader(options).read_text(std::string(text), name_for_messages, base_folder);
}

}  // namespace kaustik
