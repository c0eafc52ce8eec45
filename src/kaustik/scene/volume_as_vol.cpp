#include "kaustik/scene/volume_as_vol.h"

#include "kaustik/base/bytes.h"
#include "kaustik/scene/arguments_alone.h"
#include "kaustik/volume/volume_samples.h"

namespace kaustik {

std::vector<uint8_t> volume_as_vol(const Object& volume) {
  const VolumeSamples samples = samples_of_array(*arguments_alone(volume).array("data"));
  constexpr int32_t floats = 1;
  constexpr float unit_box[] = {0, 0, 0, 1, 1, 1};
  ByteWriter file;
  file.put_bytes("VOL\3", 4);
  file.put(floats);
  for (const int size : samples.size) file.put(int32_t(size));
  file.put(int32_t(samples.channels));
  file.put_bytes(unit_box, sizeof(unit_box));
  file.put_bytes(samples.values.data(), samples.values.size() * sizeof(float));
  return file.take();
}

}  // namespace kaustik
