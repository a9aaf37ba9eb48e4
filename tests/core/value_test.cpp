// SPDX-License-Identifier: GPL-3.0-or-later
// Types, conversions and summaries of values.
#include "msml/core/value.hpp"

#include <gtest/gtest.h>

#include "msml/core/error.hpp"

namespace msml {
namespace {

SurfacePtr triangle() {
  Surface surface;
  surface.points.resize(3, 3);
  surface.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  surface.triangles.push_back({0, 1, 2});
  return std::make_shared<const Surface>(surface);
}

TEST(Value, TypeFollowsTheAlternative) {
  EXPECT_EQ(type(Value{}), Type::nothing);
  EXPECT_EQ(type(Value{true}), Type::boolean);
  EXPECT_EQ(type(Value{Integer{3}}), Type::integer);
  EXPECT_EQ(type(Value{File{"a"}}), Type::file);
  EXPECT_EQ(type(Value{triangle()}), Type::surface);
  EXPECT_EQ(type_of<Mesh>, Type::mesh);
  EXPECT_EQ(type_of<ImageList>, Type::images);
}

TEST(Value, NamesTakeTheirArticle) {
  EXPECT_EQ(with_article(Type::mesh), "a Mesh");
  EXPECT_EQ(with_article(Type::image), "an Image");
  EXPECT_EQ(with_article(Type::index_set), "an IndexSet");
  EXPECT_EQ(with_article(Type::integers), "a list of integers");
}

TEST(Value, ConversionsLoseNothing) {
  EXPECT_EQ(std::get<double>(convert(Integer{3}, Type::number)), 3.0);
  EXPECT_EQ(std::get<std::vector<double>>(convert(std::vector<Integer>{1, 2}, Type::numbers)),
            (std::vector<double>{1, 2}));
  EXPECT_EQ(std::get<std::string>(convert(0.25, Type::text)), "0.25");
  EXPECT_EQ(std::get<MeshPtr>(convert(triangle(), Type::mesh))->count(CellKind::tri3), 1);
  const auto mesh = std::make_shared<const Mesh>();
  EXPECT_EQ(std::get<MeshPtr>(convert(std::make_shared<const Series>(Series{.last = mesh}), Type::mesh)), mesh);
}

TEST(Value, EveryConversionThatIsAllowedWorksAndNoOther) {
  const std::vector<Value> values{true,
                                  Integer{1},
                                  2.0,
                                  std::string("x"),
                                  std::vector<Integer>{1},
                                  std::vector<double>{1},
                                  std::make_shared<const Mesh>(),
                                  triangle(),
                                  std::make_shared<const Image>(),
                                  std::make_shared<const IndexSet>(),
                                  std::make_shared<const Field>()};
  for (const Value& value : values)
    for (int to = 1; to <= static_cast<int>(Type::images); ++to) {
      const Type wanted = static_cast<Type>(to);
      if (converts(type(value), wanted))
        EXPECT_EQ(type(convert(value, wanted)), wanted);
      else
        EXPECT_THROW(convert(value, wanted), Error) << name(type(value)) << " -> " << name(wanted);
    }
}

TEST(Value, NumberIsNoInteger) {
  EXPECT_FALSE(converts(Type::number, Type::integer));
  EXPECT_FALSE(converts(Type::mesh, Type::surface));
  EXPECT_FALSE(converts(Type::text, Type::number));
}

TEST(Value, SummaryIsShort) {
  EXPECT_EQ(summary(triangle()), "3 points, 1 triangles");
  EXPECT_EQ(summary(1.0 / 3), "0.333333");
  EXPECT_EQ(summary(std::make_shared<const Image>(make_image<float>({2, 3, 4}))), "2 x 3 x 4 float");
  EXPECT_EQ(summary(std::make_shared<const IndexSet>(IndexSet{.ids = std::vector<int>(1234)})), "1,234 nodes");
}

TEST(Value, BytesCountTheArrays) {
  EXPECT_EQ(bytes(std::vector<double>(10)), 80u);
  EXPECT_EQ(bytes(triangle()), 9 * sizeof(double) + 3 * sizeof(int));
  EXPECT_EQ(bytes(Value{}), 0u);
}

TEST(Numbers, AreGroupedByThousands) {
  EXPECT_EQ(with_commas(0), "0");
  EXPECT_EQ(with_commas(999), "999");
  EXPECT_EQ(with_commas(1000), "1,000");
  EXPECT_EQ(with_commas(-1234567), "-1,234,567");
}

}  // namespace
}  // namespace msml
