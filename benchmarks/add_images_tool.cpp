// add_images_tool OUT A B ...: the sum of independent renders, with the standard error of the sum,
// and what relative MSE that is.
#include <cmath>

#include "benchmarks/report.h"
#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"

int main(int argc, char** argv) {
  using namespace kaustik;
  if (argc < 3) {
    fmt::print(stderr, "usage: add_images_tool OUT A B ...\n");
    return 2;
  }
  try {
    Image sum = read_image(argv[2]);
    sum = Image(sum.width(), sum.height(), {"R", "G", "B", "error.R", "error.G", "error.B"});
    for (int i = 2; i < argc; ++i) {
      const Image part = read_image(argv[i]);
      if (part.width() != sum.width() || part.height() != sum.height())
        throw Error(ErrorKind::input, std::string(argv[i]) + " has another size", "", {});
      for (const char* layer : {"", "error"}) {
        const RgbView view = rgb_view(part, layer);
        const bool error = *layer != 0;
        for (int c = 0; c < 3; ++c)
          for (size_t k = 0; k < sum.pixel_count(); ++k) {
            float& total = sum.channel(error ? 3 + c : c)[k];
            const float value = view.planes[size_t(c)][k];
            total = error ? std::hypot(total, value) : total + value;
          }
      }
    }
    write_image(sum, argv[1]);
    fmt::print("{}: relative MSE of its own noise {:.2g}\n", argv[1], own_relative_mse(sum));
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
