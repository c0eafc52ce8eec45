# Reads CMakeLists.txt and then all sources; see check_layers.sh.

function allow(room, others,    n, names, i) {
  known[room] = 1
  may[room, room] = 1
  n = split(others, names, " ")
  for (i = 1; i <= n; ++i) may[room, names[i]] = 1
}

# A subfolder of a room may include itself, what lies in the room's own folder, and these others.
function allow_folder(folder, others,    n, names, i, room) {
  known_folder[folder] = 1
  may_folder[folder, folder] = 1
  room = folder
  sub(/\/.*/, "", room)
  n = split(others, names, " ")
  for (i = 1; i <= n; ++i) may_folder[folder, room "/" names[i]] = 1
}

# Headers that match the pattern belong to these rooms; so do names that match in_code.
function own(library, pattern, rooms, in_code,    n, names, i) {
  ++libraries
  library_name[libraries] = library
  library_pattern[libraries] = pattern
  library_code[libraries] = in_code
  n = split(rooms, names, " ")
  for (i = 1; i <= n; ++i) owns[libraries, names[i]] = 1
}

function complain(text) {
  printf "%s:%d: %s\n", FILENAME, FNR, text
  ++complaints
}

# The room that a file belongs to: src/kaustik/ROOM/…, tests/ROOM/…, apps/…, python/…, benchmarks/…, include/kaustik/….
function room_of(path,    parts) {
  split(path, parts, "/")
  if (parts[1] == "src") return parts[3]
  if (parts[1] == "tests") return parts[2]
  return parts[1]
}

# ROOM/SUBFOLDER of src/kaustik/ROOM/SUBFOLDER/FILE or kaustik/ROOM/SUBFOLDER/FILE; "" if there is none.
function folder_of(path,    parts, n) {
  sub(/^(src\/)?kaustik\//, "", path)
  n = split(path, parts, "/")
  return n > 2 ? parts[1] "/" parts[2] : ""
}

function is_product_code() { return area == "src" || area == "apps" || area == "python" || area == "include" }

# What hosts see, kaustik/NAME.h: for itself, for the room that makes it, and for what is written as hosts are.
function check_public_include(header) {
  if (!(room in sees_public)) complain("room '" room "' must not include what is for hosts, '" header "'")
}

function check_room_include(header,    parts, other) {
  if (split(header, parts, "/") == 2) {
    check_public_include(header)
    return
  }
  other = parts[2]
  if (room in sees_only_public) {
    complain("hosts do not see '" header "'")
  } else if (!(other in known)) {
    complain("there is no room '" other "'")
  } else if (is_product_code() && !((room, other) in may)) {
    complain("room '" room "' must not include '" header "'")
  } else if (!is_product_code() && !((room, other) in may) && !(room in sees_all)) {
    complain("tests of room '" room "' must not include '" header "'")
  }
  if (area == "src" && other == room && folder != "" && folder_of(header) != "" &&
      !((folder, folder_of(header)) in may_folder))
    complain("folder '" folder "' must not include '" header "'")
  if (room == "loader" && area == "src" && other == "scene" && header != "kaustik/scene/description.h")
    complain("of room 'scene' the loader may include description.h only, not '" header "'")
}

function check_library_include(header,    i) {
  for (i = 1; i <= libraries; ++i) {
    if (header !~ library_pattern[i]) continue
    if (is_product_code() && !((i, room) in owns))
      complain("room '" room "' must not include " library_name[i] " (<" header ">)")
    return
  }
  if (is_product_code() && header ~ /\.h|\// && header !~ system_headers)
    complain("<" header "> belongs to no library of the table in scripts/check_layers.awk")
}

# A library's names in a room that does not own it: its types leak although its header is not included.
function check_names(line,    i) {
  sub(/\/\/.*/, "", line)
  gsub(/"[^"]*"/, "", line)
  for (i = 1; i <= libraries; ++i)
    if (library_code[i] != "" && !((i, room) in owns) && (" " line) ~ library_code[i])
      complain("names of " library_name[i] " in room '" room "'")
}

BEGIN {
  allow("base", "")
  allow("image", "base")
  allow("display", "base image")
  allow("volume", "base")
  allow("geometry", "base image volume")
  allow("material", "base image volume")
  allow("medium", "base image volume")
  allow("light", "base image geometry")
  allow("scene", "base image geometry volume material medium light")
  allow("transport", "base image geometry volume material medium light scene")
  allow("photon", "base image geometry volume material medium light scene transport")
  allow("irradiance", "base image geometry volume material medium light scene transport")
  # Two methods over photons, which know nothing of each other.
  allow("vcm", "base image geometry volume material medium light scene transport photon irradiance")
  allow("photonmap", "base image geometry volume material medium light scene transport photon irradiance")
  allow("integrator", "base image geometry volume material medium light scene transport photon irradiance vcm photonmap")
  allow("render", \
    "base image geometry volume material medium light scene transport photon irradiance vcm photonmap " \
    "integrator")
  allow("live", \
        "base image geometry volume material medium light scene transport photon irradiance vcm photonmap integrator render")
  allow("loader", "base scene")
  # libkaustik, above all that it shows to hosts; its tests see no more than hosts do.
  allow("library", "base image scene render loader")
  sees_public["include"]; sees_public["library"]; sees_only_public["include"]
  allow("view", \
        "base image geometry volume material medium light scene transport photon irradiance vcm photonmap integrator render live")
  # The front ends get at the lower rooms through render; these are what its interface speaks of.
  allow("apps", "base image display scene integrator render loader live view")
  allow("python", "base image scene integrator render loader live view")
  # Tests of whole pictures and benchmarks may look everywhere.
  sees_all["vcm"]; sees_all["photonmap"]; sees_all["integrator"]; sees_all["render"]; sees_all["live"]; sees_all["view"]; sees_all["apps"]; sees_all["benchmarks"]
  sees_all["support"]; sees_all["fuzz"]; sees_all["agreement"]; sees_all["scene"]; sees_all["transport"]

  allow_folder("loader/pbrt", "")
  allow_folder("loader/gltf", "")
  allow_folder("photon/kd_tree", "")
  allow_folder("photon/emission", "")
  allow_folder("photon/coverage", "")
  # Plans hold what lessons taught, and lessons change plans: the two know each other.
  allow_folder("loader/radiance", "")
  allow_folder("loader/nori", "")
  allow_folder("vcm/merging", "")
  allow_folder("vcm/gathering", "")
  allow_folder("vcm/light_path", "")
  allow_folder("vcm/camera_path", "gathering merging plan lessons")
  allow_folder("vcm/plan", "camera_path gathering merging lessons")
  allow_folder("vcm/lessons", "plan")

  not_in_word = "[^A-Za-z0-9_]"
  own("Imath", "^Imath/", "base", "")
  own("oneTBB", "^(tbb|oneapi)/", "base", not_in_word "tbb::")
  own("fmt", "^fmt/", "base image geometry volume material medium light scene transport photon irradiance " \
    "vcm photonmap integrator render loader display view apps", "")
  own("OpenEXR", "^(OpenEXR/)?(Imf|Iex)", "image", not_in_word "(Imf|OPENEXR_IMF_NAMESPACE)::")
  own("libtiff", "^tiff", "image", not_in_word "TIFF[A-Z]?[a-z]*[ (*]")
  own("libpng", "^png", "image", not_in_word "png_(structp?|infop?|bytep?)" not_in_word)
  own("libjpeg", "^j(peglib|error|config|morecfg)\\.h", "image", not_in_word "jpeg_[a-z]+_struct")
  own("libwebp", "^webp/", "image", not_in_word "(WebP[A-Z]|VP8)[A-Za-z_]+[ (;]")
  own("Embree", "^embree[34]/", "geometry", not_in_word "(RTC[A-Z][A-Za-z]+|rtc[A-Z][A-Za-z]+)")
  own("Highway", "^hwy/", "light photon vcm", not_in_word "hwy::")
  own("Draco", "^draco/", "loader", not_in_word "draco::")
  own("pugixml", "^pugi", "loader", not_in_word "pugi::")
  own("zlib", "^zlib", "base", not_in_word "z_stream")
  own("pybind11", "^pybind11/", "python", not_in_word "pybind11::")
  own("MPI", "^mpi\\.h", "apps", not_in_word "MPI_[A-Z]")
  own("CLI11", "^CLI/", "apps", not_in_word "CLI::")
  own("GoogleTest", "^g(test|mock)/", "", not_in_word "testing::")
  own("nanoflann", "^nanoflann", "", not_in_word "nanoflann::")
  own("Boost", "^boost/", "view", not_in_word "boost::")
  own("nlohmann-json", "^nlohmann/", "loader view", not_in_word "nlohmann::")
  system_headers = "^(sys/[a-z]+|sanitizer/tsan_interface|unistd|fcntl|signal|sched|stdlib|malloc|immintrin|poll|netdb)\\.h$"
}

FILENAME == "CMakeLists.txt" {
  # What a room links must be among what it may include.
  if ($0 !~ /^kaustik_(shared_)?room\(/) next
  room = $1
  sub(/.*\(/, "", room)
  for (i = 2; i <= NF; ++i) {
    other = $i
    if (!sub(/^kaustik_/, "", other)) continue
    sub(/\).*/, "", other)
    if (!((room, other) in may)) complain("room '" room "' must not link '" other "'")
  }
  next
}

FNR == 1 {
  area = FILENAME
  sub(/\/.*/, "", area)
  room = room_of(FILENAME)
  if (area == "tests" && room == "library") sees_only_public[room]; else delete sees_only_public["library"]
  if (area == "src" && !(room in known))
    complain("no table knows the room '" room "': give it a line allow(...) in scripts/check_layers.awk")
  folder = area == "src" ? folder_of(FILENAME) : ""
  if (folder != "" && !(folder in known_folder))
    complain("no table knows the folder '" folder "': give it a line allow_folder(...) in scripts/check_layers.awk")
  ++files
}

/^[ \t]*#[ \t]*include[ \t]*[<"]/ {
  header = $0
  sub(/^[^<"]*[<"]/, "", header)
  sub(/[>"].*/, "", header)
  if ($0 ~ /"kaustik\// || $0 ~ /<kaustik\//) check_room_include(header)
  else if ($0 ~ /</) check_library_include(header)
  else if (area == "src") complain("write \"kaustik/ROOM/" header "\"")
  next
}

is_product_code() { check_names($0) }

END {
  if (complaints) exit 1
  if (!files) { print "no sources found"; exit 1 }
  printf "%d files keep to the table of rooms\n", files
}
