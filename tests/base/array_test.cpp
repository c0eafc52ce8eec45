// Buffers: what they refuse, whose memory they are, and their digests.

#include "kaustik/base/array.h"

#include <gtest/gtest.h>

#include <limits>

#include "kaustik/base/parameters.h"

namespace kaustik {
namespace {

std::string text_of_error(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "";
}

TEST(Array, HoldsWhatItWasGiven) {
  const auto array = Array::of<float>({2, 3}, {1, 2, 3, 4, 5, 6});
  EXPECT_EQ(array->type(), ElementType::float32);
  EXPECT_EQ(array->extents(), (std::vector<size_t>{2, 3}));
  EXPECT_EQ(array->count(), 6u);
  double sum = 0;
  array->visit([&](auto values) {
    for (const auto value : values) sum += double(value);
  });
  EXPECT_EQ(sum, 21);
  EXPECT_EQ(Array::of<uint8_t>({0, 3}, {})->count(), 0u);
  EXPECT_EQ(Array::of<int64_t>({}, {7})->count(), 1u);
}

TEST(Array, BorrowsMemoryAndKeepsItsOwner) {
  auto memory = std::make_shared<std::vector<uint32_t>>(std::vector<uint32_t>{4, 5, 6});
  const std::weak_ptr<std::vector<uint32_t>> watched = memory;
  const void* where = memory->data();
  auto array = Array::borrow(ElementType::uint32, {3}, std::as_bytes(std::span(*memory)), memory);
  memory.reset();
  EXPECT_FALSE(watched.expired());
  EXPECT_EQ(array->bytes().data(), where);  // no copy
  array.reset();
  EXPECT_TRUE(watched.expired());
}

TEST(Array, RefusesExtentsThatAreNotThoseOfItsMemory) {
  EXPECT_NE(text_of_error([] {
              Array::of<float>({2, 2}, {1, 2, 3});
            }).find("[2, 2]"),
            std::string::npos);
  const size_t huge = std::numeric_limits<size_t>::max() / 2;
  // Their product is 4 × 3 bytes, but for its overflow.
  EXPECT_NE(text_of_error([&] { Array::of<float>({huge + 1, 2, 3}, {1, 2, 3}); }), "");
  EXPECT_NE(text_of_error([&] { Array::of<uint8_t>({huge, huge}, {1}); }), "");
  alignas(8) const std::array<std::byte, 16> bytes{};
  EXPECT_EQ(text_of_error([&] {
              Array::borrow(ElementType::uint8, {3}, std::span(bytes).subspan(1, 3), nullptr);
            }),
            "");
  EXPECT_NE(text_of_error([&] {
              Array::borrow(ElementType::float64, {1}, std::span(bytes).subspan(4, 8), nullptr);
            }).find("multiple of 8"),
            std::string::npos);
}

TEST(Array, DigestsTellContentsTypesAndExtentsApart) {
  const auto array = Array::of<uint16_t>({2, 2}, {1, 2, 3, 4});
  EXPECT_EQ(array->digest(), Array::of<uint16_t>({2, 2}, {1, 2, 3, 4})->digest());
  EXPECT_EQ(array->digest(), array->digest());
  EXPECT_NE(array->digest(), Array::of<uint16_t>({2, 2}, {1, 2, 3, 5})->digest());
  EXPECT_NE(array->digest(), Array::of<uint16_t>({4}, {1, 2, 3, 4})->digest());
  EXPECT_NE(Array::of<uint32_t>({1}, {0})->digest(), Array::of<int32_t>({1}, {0})->digest());
}

const TypeInfo& array_table() {
  static const TypeInfo info{"shape",
                             "grid",
                             "A grid.",
                             {array_parameter("points", {0, 3}, "Its points."),
                              array_parameter("cells", {0, 2}, "Its cells.").integers(),
                              file_parameter("filename", "Its file."),
                              array_parameter("data", {}, "Its buffer.").instead_of("filename")}};
  return info;
}

struct CheckedArrays {
  Arguments arguments;
  std::string text;
};
CheckedArrays check_arrays(std::vector<Property> properties) {
  Problems problems;
  Arguments arguments(array_table(), properties, place_in("python"), problems);
  return {std::move(arguments), text_of_error([&] { problems.throw_if_any(); })};
}

TEST(ArrayParameters, TakeTheExtentsThatTheyAskFor) {
  const auto points = Array::of<float>({1, 3}, {1, 2, 3});
  const Property file{"filename", Value(std::string("a")), {}};
  const CheckedArrays right = check_arrays({{"points", Value(points), {}}, file});
  EXPECT_EQ(right.text, "");
  EXPECT_EQ(right.arguments.array("points"), points);
  EXPECT_EQ(right.arguments.array("cells"), nullptr);
  const auto wrong = [&](const std::string& name, const Value& value, const std::string& message) {
    EXPECT_NE(check_arrays({{name, value, {}}, file}).text.find(message), std::string::npos)
        << check_arrays({{name, value, {}}, file}).text;
  };
  wrong("points", Value(Array::of<float>({3, 1}, {1, 2, 3})), "'points' has the extents [3, 1]");
  wrong("points", Value(Array::of<float>({3}, {1, 2, 3})), "give an array [n, 3]");
  wrong("cells", Value(Array::of<float>({1, 2}, {0, 1})), "'cells' holds float32");
  wrong("points", Value(1.0), "'points' has the wrong type");
  wrong("points", Value(std::shared_ptr<const Array>()), "'points' has the wrong type");
  wrong("points", Value(Untyped{"1 2 3"}), "'points' has the wrong type");
}

TEST(ArrayParameters, OneMayStandInsteadOfAnother) {
  const Property file{"filename", Value(std::string("a")), {}};
  const Property data{"data", Value(Array::of<uint8_t>({1}, {1})), {}};
  EXPECT_TRUE(check_arrays({file}).arguments.is_complete());
  const CheckedArrays by_data = check_arrays({data});
  EXPECT_EQ(by_data.text, "");
  EXPECT_TRUE(by_data.arguments.is_complete());
  EXPECT_NE(check_arrays({}).text.find("needs 'filename'"), std::string::npos);
  EXPECT_FALSE(check_arrays({}).arguments.is_complete());
  EXPECT_NE(check_arrays({file, data}).text.find("has both 'data' and 'filename'"),
            std::string::npos);
  EXPECT_FALSE(check_arrays({{"data", Value(1.0), {}}}).arguments.is_complete());
}

}  // namespace
}  // namespace kaustik
