#include "kaustik/view/assets.h"

namespace kaustik::view {

std::string_view content_type_of(std::string_view name) {
  struct Row {
    std::string_view extension, type;
  };
  static constexpr Row rows[] = {{".html", "text/html; charset=utf-8"},
                                 {".js", "text/javascript; charset=utf-8"},
                                 {".css", "text/css; charset=utf-8"},
                                 {".svg", "image/svg+xml"},
                                 {".png", "image/png"},
                                 {".txt", "text/plain; charset=utf-8"},
                                 {".woff2", "font/woff2"}};
  for (const Row& row : rows)
    if (name.ends_with(row.extension)) return row.type;
  return "application/octet-stream";
}

}  // namespace kaustik::view
