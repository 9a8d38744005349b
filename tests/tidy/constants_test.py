#!/usr/bin/env python3
"""The rule of named numeric constants finds each way to write one, and nothing else."""
import pathlib
import tempfile
import unittest

import constants

COUNTED = {
    "constexpr double kA = 0.5;": ["kA"],
    "static constexpr std::size_t kRanges = 5, kSectors = 7;": ["kRanges", "kSectors"],
    "inline constexpr float kA{1e-3F};": ["kA"],
    "const double kA(0.5);": ["kA"],
    "double const kA = -1'000.0;": ["kA"],
    "auto constexpr kA = 0x1fU;": ["kA"],
    "template <typename Real>\nconstexpr Real kLogPi = Real(1.14);": ["kLogPi"],
    "constexpr std::array<double, 2> kTable{1.0,\n  2.0};": ["kTable"],
    "constexpr auto kTable = std::array<double, 2>{1.0, 2.0};": ["kTable"],
    "const std::vector<double> edges_m = {1.0, 2.0};": ["edges_m"],
    "constexpr double kTable[] = {1.0, 2.0};": ["kTable"],
    "constexpr int kTable[2][2] = {{1, 2}, {3, 4}};": ["kTable"],
    "void f() {\n  const double least_m = 0.1;\n}": ["least_m"],
    "void f() {\n  static const int rounds = static_cast<int>(10);\n}": ["rounds"],
    "constexpr double kUniform = std::numbers::pi / 3.0;": ["kUniform"],
    "const double twice = 2.0 * kA;": ["twice"],
    "constexpr double kA = std::max(0.5, kB);": ["kA"],
    "struct S {\n  static constexpr int kA = 3;\n  const double b = 0.25;\n};": ["kA", "b"],
    "#define LEAST 1e-9": ["LEAST"],
    "enum : int { kA = 3, kB };": ["kA"],
}
NOT_COUNTED = [
    "constexpr double half(double x) { return 0.5 * x; }",
    "constexpr double half(double x);",
    "[[nodiscard]] double rate() const { return 2.0 * rate_; }",
    "void f(const double x = 0.5);",
    "void f() const;",
    "double least_m = 0.5;",
    "const double range_m = std::max(0.5, x);",
    "const auto half = [](double x) { return 0.5 * x; };",
    "constexpr auto half = [](double x) { return 0.5 * x; };",
    "const auto& [a, b] = pair;",
    "for (const double x : {1.0, 2.0}) use(x);",
    "for (const Record& r : records) r.x = 0.5;",
    "if constexpr (kA > 2) x = 3;",
    "constexpr double kFar = std::numeric_limits<double>::infinity();",
    "constexpr auto kLong = static_cast<std::size_t>(Class::kTruck);",
    "enum class State : std::uint8_t { kIdle = 0, kBusy = 1 };",
    "// constexpr double kA = 0.5;",
    "/* const double a = 0.5; */",
    'const char* text = "x = 0.5";',
    "const Thing thing{name, 0.5 * width};",
    "const double first = values[0];",
]


class Constants(unittest.TestCase):
    def test_each_way_to_write_one(self):
        for text, names in COUNTED.items():
            with self.subTest(text):
                self.assertEqual([name for _, name in constants.constants(text)], names)

    def test_nothing_else(self):
        for text in NOT_COUNTED:
            with self.subTest(text):
                self.assertEqual(constants.constants(text), [])

    def test_line(self):
        self.assertEqual(constants.constants("/* a\n b */\n\nconstexpr int kA = 3;\n"), [(4, "kA")])

    def test_number_of_constants(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path("services/tracker/core/x.cpp")
            (pathlib.Path(folder) / path).parent.mkdir(parents=True)

            def found(number):
                text = "".join(f"constexpr int k{i} = {i};\n" for i in range(number))
                (pathlib.Path(folder) / path).write_text(text)
                return list(constants.findings(pathlib.Path(folder), [path]))

            self.assertEqual(found(constants.MAX_CONSTANTS), [])
            lines = found(constants.MAX_CONSTANTS + 1)
            self.assertEqual(len(lines), 1)
            number = constants.MAX_CONSTANTS + 1
            self.assertIn(f"{number} named numeric constants", lines[0])
            self.assertIn(f"x.cpp:{number} k{number - 1}", lines[0])


if __name__ == "__main__":
    unittest.main()
