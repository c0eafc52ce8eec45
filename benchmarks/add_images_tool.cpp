// add_images_tool A B OUT: the sum of two independent renders, with the standard error of the sum.
#include <cmath>

#include "benchmarks/report.h"
#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"

int main(int argc, char** argv) {
  using namespace kaustik;
  if (argc != 4) return 2;
  try {
    const Image a = read_image(argv[1]), b = read_image(argv[2]);
    Image sum(a.width(), a.height(), {"R", "G", "B", "error.R", "error.G", "error.B"});
    for (const char* layer : {"", "error"}) {
      const RgbView x = rgb_view(a, layer), y = rgb_view(b, layer);
      const bool error = *layer != 0;
      for (int c = 0; c < 3; ++c)
        for (size_t i = 0; i < sum.pixel_count(); ++i) {
          const float u = x.planes[size_t(c)][i], v = y.planes[size_t(c)][i];
          sum.channel(error ? 3 + c : c)[i] = error ? std::hypot(u, v) : u + v;
        }
    }
    write_image(sum, argv[3]);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
