#include "services/base/app.h"

#include <gtest/gtest.h>

namespace beckon {
namespace {

TEST(Within, TakesNumbersOfItsRangeOnly) {
  const auto check = Within(0, 0.5);
  for (const char* right : {"0", "0.5", "1e-3", " 0.25"}) EXPECT_EQ(check(right), "") << right;
  for (const char* wrong : {"", "nan", "-nan", "inf", "-0.1", "0.6", "0.1x", "x"})
    EXPECT_NE(check(wrong), "") << wrong;
  EXPECT_EQ(check("nan"), "expected a number from 0 to 0.5, found nan");
}

}  // namespace
}  // namespace beckon
