#include "kaustik/base/scratch.h"

#include <gtest/gtest.h>

namespace kaustik {
namespace {

TEST(Scratch, ListsKeepTheirMemory) {
  Scratch scratch;
  const int* first = nullptr;
  {
    const auto list = scratch.list<int>();
    list->assign(100, 7);
    first = list->data();
  }
  const auto other_type = scratch.list<float>();
  EXPECT_TRUE(other_type->empty());
  const auto again = scratch.list<int>();
  EXPECT_TRUE(again->empty());
  EXPECT_GE(again->capacity(), 100u);
  EXPECT_EQ(again->data(), first);
}

TEST(Scratch, ObjectsAreAsTheirLastBorrowerLeftThem) {
  struct Number {
    int value = 3;
  };
  Scratch scratch;
  {
    const auto number = scratch.borrow<Number>();
    EXPECT_EQ(number->value, 3);
    number->value = 4;
  }
  EXPECT_EQ(scratch.borrow<Number>()->value, 4);
}

/// Who computes within another computation has objects of his own.
TEST(Scratch, BorrowersDoNotShare) {
  Scratch scratch;
  const auto outer = scratch.list<int>();
  outer->push_back(1);
  {
    const auto inner = scratch.list<int>();
    EXPECT_NE(&*inner, &*outer);
    inner->assign(5, 2);
  }
  const auto third = scratch.list<int>();
  EXPECT_TRUE(third->empty());
  EXPECT_EQ(*outer, std::vector<int>{1});
}

/// Shelves of other types may move meanwhile.
TEST(Scratch, ObjectsGoBackToTheirOwnShelf) {
  Scratch scratch;
  const int* data = nullptr;
  {
    const auto list = scratch.list<int>();
    list->push_back(1);
    data = list->data();
    const auto a = scratch.list<char>();
    const auto b = scratch.list<float>();
    const auto c = scratch.list<double>();
    const auto d = scratch.list<long>();
  }
  EXPECT_EQ(scratch.borrow<std::vector<int>>()->data(), data);
  EXPECT_TRUE(scratch.borrow<std::vector<long>>()->empty());
}

}  // namespace
}  // namespace kaustik
