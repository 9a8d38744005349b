#include "services/common/runtime/config/reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/common/runtime/config/former_keys.hpp"

namespace boresight::config {
namespace {

using testing::HasSubstr;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Reader, ReadsEveryType) {
  Reader root =
      Reader::parse("a = 1.5\nb = 3\nc = true\nd = \"word\"\ne = [1, 2.5]\nf_deg = 180.0\nm = \"two\"\n", "x.toml");
  EXPECT_EQ(root.number("a", {0, 2}, 0), 1.5);
  EXPECT_EQ(root.number("b", {0, 5}, 0), 3.0) << "an integer serves as a number";
  EXPECT_EQ(root.integer("b", {0, 5}, 0), 3);
  EXPECT_TRUE(root.boolean("c", false));
  EXPECT_EQ(root.text("d", ""), "word");
  EXPECT_EQ(root.numbers("e", 2, {}, {0, 0}), (std::vector<double>{1, 2.5}));
  EXPECT_DOUBLE_EQ(root.angle_deg("f_deg", {-180, 180}, 0), M_PI);
  EXPECT_EQ(root.choice<int>("m", {{"one", 1}, {"two", 2}}, 0), 2);
  EXPECT_NO_THROW(root.finish());
}

TEST(Reader, AbsentKeysKeepTheirDefault) {
  Reader root = Reader::parse("", "x.toml");
  EXPECT_EQ(root.number("a", {0, 1}, 0.5), 0.5);
  EXPECT_EQ(root.table("t").integer("n", {0, 9}, 7), 7);
  EXPECT_TRUE(root.tables("list").empty());
  EXPECT_NO_THROW(root.finish());
}

TEST(Reader, OutOfRangeNamesFileLineKeyAndRange) {
  Reader root = Reader::parse("# comment\nlimit = 9\n", "dir/x.toml");
  EXPECT_EQ(root.number("limit", {0, 5}, 1), 1);
  const std::string text = error_of([&] { root.finish(); });
  EXPECT_EQ(text, "dir/x.toml:2: limit: 9 is out of range; allowed: 0 … 5");
}

TEST(Reader, NotANumberIsOutOfRange) {
  Reader root = Reader::parse("limit = nan\n", "x.toml");
  EXPECT_EQ(root.number("limit", {0, 5}, 1), 1);
  EXPECT_THAT(error_of([&] { root.finish(); }), HasSubstr("x.toml:1: limit: nan is out of range"));
}

TEST(Reader, WrongTypeNamesTheRequiredType) {
  Reader root = Reader::parse("limit = \"5\"\n", "x.toml");
  EXPECT_EQ(root.integer("limit", {0, 5}, 1), 1);
  EXPECT_THAT(error_of([&] { root.finish(); }),
              HasSubstr("x.toml:1: limit: must be an integer (0 … 5), but is a string"));
}

TEST(Reader, UnknownKeyIsAnErrorThatNamesTheNearestAndAllKnownKeys) {
  Reader root = Reader::parse("[t]\nlimitt = 5\ncolour = 1\n", "x.toml");
  Reader t = root.table("t");
  static_cast<void>(t.number("limit", {}, 1));
  static_cast<void>(t.number("size", {}, 1));
  EXPECT_EQ(error_of([&] { root.finish(); }),
            "x.toml:2: t.limitt: unknown key; similar: 'limit'; known here: limit, size\n"
            "x.toml:3: t.colour: unknown key; known here: limit, size");
}

TEST(Reader, RenamedKeyIsAnErrorThatNamesTheKeyOfToday) {
  for (const RenamedKey& key : kRenamedKeys) {
    const std::string former(key.former), current(key.current);
    Reader root = Reader::parse("[filter." + former + "]\na = 1\n[[radars." + former + "]]\na = 1\n", "x.toml");
    static_cast<void>(root.table("filter").table(current).number("a", {}, 1));
    static_cast<void>(root.table("radars").tables(current));
    EXPECT_EQ(error_of([&] { root.finish(); }), "x.toml:1: filter." + former + ": is called '" + current + "' now\n" +
                                                    "x.toml:3: radars." + former + ": is called '" + current + "' now");
  }
}

TEST(Reader, MovedKeyIsAnErrorThatNamesItsPlaceOfToday) {
  for (const MovedKey& key : kMovedKeys) {
    const std::string former(key.former), beside(key.beside);
    Reader root = Reader::parse("[t]\n" + former + " = 1\n[u]\n" + former + " = 1\n", "x.toml");
    static_cast<void>(root.table("t").number(beside, {}, 1));
    static_cast<void>(root.table("u").number("limit", {}, 1));
    EXPECT_EQ(error_of([&] { root.finish(); }), "x.toml:2: t." + former + ": is " + std::string(key.current) +
                                                    " now\n" + "x.toml:4: u." + former +
                                                    ": unknown key; known here: limit");
  }
}

TEST(Reader, FormerKeyIsAnOrdinaryUnknownKeyWhereTheNewOneIsNotKnown) {
  const std::string former(kRenamedKeys.front().former);
  Reader root = Reader::parse(former + " = 1\n", "x.toml");
  static_cast<void>(root.number("limit", {}, 1));
  EXPECT_EQ(error_of([&] { root.finish(); }), "x.toml:1: " + former + ": unknown key; known here: limit");
}

TEST(Reader, ASkippedKeyIsKnownWithoutBeingRead) {
  Reader root = Reader::parse("a = 1\nb = \"anything\"\n[t]\nx = 1\n[u]\nx = 1\n", "x.toml");
  static_cast<void>(root.integer("a", {0, 9}, 0));
  root.skip("b");
  root.skip("t");
  root.skip("absent");
  EXPECT_EQ(error_of([&] { root.finish(); }), "x.toml:5: u: unknown key; known here: a, absent, b, t");
}

TEST(Reader, SkippedOthersHideNoErrorOfWhatIsRead) {
  Reader root = Reader::parse("a = 99\nb = 1\n[t]\nx = 1\ny = 2\n[u]\nx = 1\n", "x.toml");
  static_cast<void>(root.integer("a", {0, 9}, 0));
  static_cast<void>(root.table("t").integer("x", {0, 9}, 0));
  root.skip_others();
  EXPECT_EQ(error_of([&] { root.finish(); }),
            "x.toml:1: a: 99 is out of range; allowed: 0 … 9\nx.toml:5: t.y: unknown key; known here: x");
  Reader absent = root.table("none");
  EXPECT_NO_THROW(absent.skip_others());
}

TEST(Reader, UnknownTableIsAnError) {
  Reader root = Reader::parse("[tt]\nlimit = 5\n", "x.toml");
  EXPECT_THAT(error_of([&] { root.finish(); }), HasSubstr("tt: unknown key"));
}

TEST(Reader, ReportsAllErrorsInTheOrderOfLines) {
  Reader root = Reader::parse("b = 9\na = 9\n", "x.toml");
  static_cast<void>(root.number("a", {0, 1}, 0));
  static_cast<void>(root.number("b", {0, 1}, 0));
  const std::string text = error_of([&] { root.finish(); });
  EXPECT_LT(text.find("x.toml:1: b"), text.find("x.toml:2: a"));
}

TEST(Reader, MissingRequiredKeyNamesTheTablesLine) {
  Reader root = Reader::parse("\n\n[t]\n", "x.toml");
  root.table("t").require("id");
  EXPECT_EQ(error_of([&] { root.finish(); }), "x.toml:3: t.id: is missing");
}

TEST(Reader, MissingRequiredKeyNamesTheAllowedValues) {
  Reader root = Reader::parse("\n[t]\n", "x.toml");
  Reader t = root.table("t");
  for (const char* key : {"n", "i", "c"}) t.require(key);
  static_cast<void>(t.number("n", {0.5, 2}, 1));
  static_cast<void>(t.number("n", {0.5, 2}, 1));
  static_cast<void>(t.integer("i", {1, 16}, 1));
  static_cast<void>(t.choice<int>("c", {{"red", 1}, {"blue", 2}}, 1));
  EXPECT_EQ(error_of([&] { root.finish(); }),
            "x.toml:2: t.n: is missing; allowed: 0.5 … 2\nx.toml:2: t.i: is missing; allowed: 1 … 16\n"
            "x.toml:2: t.c: is missing; must be one of \"red\", \"blue\"");
}

TEST(Reader, PlaceOfAKeyNamesFileLineAndTable) {
  Reader root = Reader::parse("[[r]]\n[[r]]\nn = 1\n", "x.toml");
  std::vector<Reader> readers = root.tables("r");
  EXPECT_EQ(readers[1].place("n"), "x.toml:3: r[1].n");
  EXPECT_EQ(readers[0].place("n"), "x.toml:1: r[0].n") << "the table's, where the key is absent";
}

TEST(Reader, ElementsOfATableListAreNumbered) {
  Reader root = Reader::parse("[[r]]\nn = 1\n[[r]]\nn = 99\n", "x.toml");
  for (Reader& r : root.tables("r")) static_cast<void>(r.integer("n", {0, 9}, 0));
  EXPECT_THAT(error_of([&] { root.finish(); }), HasSubstr("x.toml:4: r[1].n: 99 is out of range"));
}

TEST(Reader, BrokenTomlNamesTheLine) {
  EXPECT_THAT(error_of([] { static_cast<void>(Reader::parse("a = 1\nb = = 2\n", "x.toml")); }),
              HasSubstr("x.toml:2: not valid TOML"));
}

// Found by fuzzing: the parser asserts, or runs into undefined behaviour.
TEST(Reader, MalformedTextThatTheParserAcceptsIsRejected) {
  for (const std::string_view text : {"[, a = 1", "[[= 1", "[[[a]]]"}) {
    EXPECT_THAT(error_of([&] { static_cast<void>(Reader::parse(text, "x.toml")); }), HasSubstr("not valid TOML"))
        << text;
  }
  for (const std::string_view text :
       {"\nb = [0, Ţ\n", "\nc = 1 °", "\né = 1", "\nd = \"open°\n°", "\ne = \"\"\"x\"\"\" °", "\nf =0\"x°"}) {
    EXPECT_THAT(error_of([&] { static_cast<void>(Reader::parse(text, "x.toml")); }),
                HasSubstr("x.toml:2: not valid TOML"))
        << text;
  }
}

TEST(Reader, AllCharactersAreAllowedInStringsAndComments) {
  constexpr std::string_view kText = R"toml(# 0 … 1 "
a = "\"°" # ° '
b = '''°
°'''
c = '°\'
d = """°
"°\""""
e = "a ~ b ~x41"
[f]
"°" = 1
)toml";
  Reader root = Reader::parse("\xEF\xBB\xBF" + std::string(kText), "x.toml");
  EXPECT_EQ(root.text("a", ""), "\"°");
  EXPECT_EQ(root.text("b", ""), "°\n°");
  EXPECT_EQ(root.text("c", ""), "°\\");
  EXPECT_EQ(root.text("d", ""), "°\n\"°\"");
  EXPECT_EQ(root.text("e", ""), "a ~ b ~x41");
  static_cast<void>(root.table("f").has("x"));
  EXPECT_THAT(error_of([&] { root.finish(); }), HasSubstr("x.toml:10: f.°: unknown key"));
}

TEST(Reader, ListsOfIntegers) {
  Reader root = Reader::parse("a = [3, -4]\nb = [1]\nc = [1.5]\nd = [1, 99]\ne = 1\n", "x.toml");
  EXPECT_THAT(root.integers("a", {1, 4}, {-9, 9}, {}), testing::ElementsAre(3, -4));
  EXPECT_THAT(root.integers("absent", {1, 4}, {-9, 9}, {7}), testing::ElementsAre(7));
  EXPECT_THAT(root.integers("b", {2, 2}, {0, 9}, {5, 6}), testing::ElementsAre(5, 6));
  for (const char* key : {"c", "d", "e"}) EXPECT_THAT(root.integers(key, {1, 4}, {0, 9}, {}), testing::IsEmpty());
  const std::string error = error_of([&] { root.finish(); });
  EXPECT_THAT(error, HasSubstr("x.toml:2: b: has 1 elements; must be an array of integers (0 … 9), their number 2"));
  EXPECT_THAT(error, HasSubstr("x.toml:3: c: element 1 is not an integer in range"));
  EXPECT_THAT(error, HasSubstr("x.toml:4: d: element 2 is not an integer in range"));
  EXPECT_THAT(error, HasSubstr("x.toml:5: e: must be an array of integers"));
}

TEST(Reader, NumberOfTablesIsChecked) {
  Reader root = Reader::parse("few = []\n[[many]]\n[[many]]\n[[right]]\n", "x.toml");
  for (const char* key : {"few", "many", "right", "absent"}) static_cast<void>(root.tables(key, {1, 1}));
  EXPECT_EQ(error_of([&] { root.finish(); }),
            "x.toml:1: few: has 0 tables; their number must be 1 … 1\n"
            "x.toml:2: many: has 2 tables; their number must be 1 … 1");
}

TEST(Reader, ErrorsOfADamagedFileAreLimitedAndPrintable) {
  std::string text = "word = \"\\u001b[2J\\nsecond line " + std::string(100'000, 'x') + "\"\n";
  for (int i = 0; i < 10'000; ++i) text += "k" + std::to_string(i) + " = 1\n";
  Reader root = Reader::parse(text, "x.toml");
  static_cast<void>(root.choice<int>("word", {{"one", 1}}, 1));
  const std::string problems = error_of([&] { root.finish(); });
  EXPECT_LT(problems.size(), 20'000u);
  EXPECT_THAT(problems, HasSubstr("x.toml:1: word: \"?[2J?second line xx"));
  EXPECT_THAT(problems, HasSubstr("\nx.toml: 9951 more problems"));
}

TEST(Reader, UnreadableFileIsNamed) {
  EXPECT_THAT(error_of([] { static_cast<void>(Reader::open("/nowhere/x.toml")); }),
              HasSubstr("/nowhere/x.toml: cannot"));
  EXPECT_THAT(error_of([] { static_cast<void>(Reader::open("/")); }), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace boresight::config
