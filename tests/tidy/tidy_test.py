"""The checks themselves: each finds its problems and accepts valid sources."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import arrows  # noqa: E402
import bilingual  # noqa: E402
import class_size  # noqa: E402
import codes  # noqa: E402
import function_length  # noqa: E402
import text_rules  # noqa: E402
import words  # noqa: E402

HEADERS = {
    "include/kerf/base/units.h": "",
    "include/kerf/geom/geometry.h": '#include "kerf/base/units.h"\n',
    "include/kerf/path/toolpath.h": '#include "kerf/geom/geometry.h"\n',
    "include/kerf/sim/simulate.h": '#include "kerf/geom/geometry.h"\n',
    "include/kerf/program/gcode.h": "",
}


def arrow_problems(path, text):
    return arrows.check({**HEADERS, path: text})


class Bilingual(unittest.TestCase):
    def test_messages_in_two_languages_pass(self):
        two = 'constexpr Bilingual kA{"no {} " "left", "kein {} mehr"};'
        self.assertEqual(bilingual.check("a.cpp", two), [])
        self.assertEqual(bilingual.check_plain("a.cpp", 'print_line("Kerf " KERF_VERSION);'), [])

    def test_missing_german_is_found(self):
        for wrong in ('kA{"none {}", "none {}"}', 'kA{"none", ""}', 'kA{"none {}", "keine"}',
                      'kA = {"a", "b"}'):
            self.assertTrue(bilingual.check("a.cpp", f"constexpr Bilingual {wrong};"), wrong)
        for wrong in ('print_line("Writing " + file);', 'diagnostics_.error(codes::x, {}, "no such file");'):
            self.assertTrue(bilingual.check_plain("a.cpp", wrong), wrong)


class Arrows(unittest.TestCase):
    def test_right_arrows_pass(self):
        text = '#include "kerf/path/toolpath.h"\n#include <map>\n'
        self.assertEqual(arrow_problems("src/sim/cut/x.cpp", text), [])
        self.assertEqual(arrow_problems("src/app/main.cpp", '#include "kerf/sim/simulate.h"\n'), [])

    def test_a_wrong_include_is_found_with_its_line(self):
        problems = arrow_problems("src/geom/base/arc.cpp", '// x\n#include "kerf/sim/simulate.h"\n')
        self.assertEqual(len(problems), 1)
        self.assertIn("src/geom/base/arc.cpp:2: wrong arrow", problems[0])

    def test_simulator_may_not_see_a_front_end(self):
        self.assertTrue(arrow_problems("src/sim/cut/x.cpp", '#include "kerf/program/gcode.h"\n'))

    def test_rooms_of_the_simulator_have_arrows_of_their_own(self):
        kernels = '#include "sim/kernel/kernels.h"\n'
        texts = {**HEADERS, "src/sim/kernel/kernels.h": ""}
        self.assertEqual(arrows.check({**texts, "src/sim/cut/x.cpp": kernels}), [])
        self.assertIn("wrong arrow", arrows.check({**texts, "src/sim/mesh/x.cpp": kernels})[0])
        self.assertTrue(arrow_problems("src/sim/x.cpp", ""))

    def test_internal_headers_count_too(self):
        texts = {**HEADERS, "src/path/inner.h": "", "src/codec/gcode/words.cpp": '#include "path/inner.h"\n'}
        self.assertIn("wrong arrow", arrows.check(texts)[0])
        texts = {**HEADERS, "src/sim/cut/inner.h": "", "src/sim/cut/other.cpp": '#include "inner.h"\n'}
        self.assertEqual(arrows.check(texts), [])

    def test_a_unit_test_sees_what_its_module_sees(self):
        text = '#include "kerf/sim/simulate.h"\n'
        self.assertEqual(arrow_problems("tests/unit/sim_cut/x_test.cpp", text), [])
        self.assertTrue(arrow_problems("tests/unit/geom/x_test.cpp", text))

    def test_rooms_of_a_module(self):
        inner = {"src/front/gcmc/value/v.h": "", "src/front/gcmc/run/r.h": ""}
        self.assertEqual(arrows.module_of("src/front/gcmc/run/r.h"), "front_gcmc_run")
        for path, name in (("src/front/gcmc/run/x.cpp", "front/gcmc/value/v.h"),
                           ("src/front/gcmc/program.cpp", "front/gcmc/run/r.h"),
                           ("tests/unit/front_gcmc_value/x_test.cpp", "front/gcmc/value/v.h"),
                           ("src/app/x.cpp", "front/gcmc/run/r.h")):
            self.assertEqual(arrows.check({**inner, path: f'#include "{name}"\n'}), [], path)
        for path in ("src/front/gcmc/value/x.cpp", "tests/unit/front_gcmc_value/x_test.cpp",
                     "src/front/gcode/x.cpp"):
            self.assertIn("wrong arrow", arrows.check({**inner, path: '#include "front/gcmc/run/r.h"\n'})[0])
        self.assertIn("unknown module", arrows.check({"src/front/gcmc/unknown/x.cpp": ""})[0])
        self.assertEqual(arrows.check_links({"a": "kerf_module(front_gcmc DEPENDS front_gcmc_run base)"}), [])
        self.assertTrue(arrows.check_links({"a": "kerf_module(front_gcmc_value DEPENDS front_gcmc_run)"}))

    def test_rings_and_unknown_headers_are_found(self):
        texts = {**HEADERS, "src/sim/cut/a.h": '#include "b.h"\n', "src/sim/cut/b.h": '#include "a.h"\n'}
        self.assertIn("ring", arrows.check(texts)[0])
        self.assertTrue(arrow_problems("include/kerf/surprise.h", ""))
        self.assertTrue(arrow_problems("src/sim/cut/x.cpp", '#include "kerf/no_such.h"\n'))

    def test_links_are_arrows(self):
        right = arrows.check_links({"a": "kerf_module(geom_base DEPENDS base LIBRARIES fmt::fmt)"})
        self.assertEqual(right, [])
        wrong = arrows.check_links({"a": "kerf_module(geom_base DEPENDS base path)"})
        self.assertEqual(wrong, ["a: wrong arrow: geom_base links path"])
        self.assertTrue(arrows.check_links({"a": "kerf_module(surprise)"}))

    def test_the_table_of_headers_agrees(self):
        text = "\n".join(f"| `src/{module.replace('_', '/')}` | x | {' '.join(f'`{h}`' for h in headers)} |"
                         for module, headers in arrows.PUBLIC.items())
        self.assertEqual(arrows.check_table(text), [])
        self.assertEqual(len(arrows.check_table(text.replace("`base/units.h`", "`base/unit.h`"))), 2)
        self.assertIn("no row", arrows.check_table(text.replace("`src/base`", "`src/bass`"))[0])

    def test_the_table_itself_forms_no_ring(self):
        table = {module: sorted(uses) for module, uses in arrows.ALLOWED.items()}
        self.assertEqual(arrows.rings(table), [])


class FunctionLength(unittest.TestCase):
    def lengths(self, text):
        return {name: lines for name, _, lines in function_length.functions(text)}

    def test_counts_from_head_to_brace(self):
        text = ("namespace a {\nint f(int x,\n      int y) {\n  if (x) {\n    return y;\n  }\n"
                "  return 0;\n}\n}\n")
        self.assertEqual(self.lengths(text), {"f": 7})

    def test_members_constructors_and_operators_are_functions(self):
        text = ("class C {\n  C() : a_{1}, b_(2) {\n    g();\n  }\n"
                "  int operator()(int x) const {\n    return x;\n  }\n"
                "  int a_ = 0;\n  int v_[2] = {1, 2};\n};\n"
                "template <class T>\nauto C::h(T t) -> int {\n  return 1;\n}\n")
        self.assertEqual(self.lengths(text), {"C": 3, "operator()": 3, "C::h": 4})

    def test_tables_lambdas_and_literals_do_not_confuse(self):
        text = ('const int table[] = {\n  1,\n  2,\n};\nvoid f() {\n  auto g = [](int x) { return x; };\n'
                '  h("}", \'{\', 1\'000);  // }\n}\nvoid k() {}\n')
        self.assertEqual(self.lengths(text), {"f": 4, "k": 1})

    def test_the_ratchet_only_shrinks(self):
        self.assertEqual(function_length.compare({"a f": 90}, {"a f": 90}), [])
        self.assertIn("grew", function_length.compare({"a f": 91}, {"a f": 90})[0])
        self.assertIn("split it", function_length.compare({"a f": 91}, {})[0])
        self.assertIn("lower", function_length.compare({"a f": 80}, {"a f": 90})[0])
        self.assertIn("remove", function_length.compare({}, {"a f": 90})[0])


class ClassSize(unittest.TestCase):
    def sizes(self, text):
        return {name: (n["functions"], n["members"]) for name, n in class_size.classes(text)}

    def test_counts_functions_and_members(self):
        text = ("class A final : public B<int> {\n public:\n  A() : x_{1}, y_(2) { f(); }\n  ~A();\n"
                "  virtual int f(int x = 1) const = 0;\n  A& operator=(const A&) = default;\n"
                "  bool operator<(const A& o) const { return x_ < o.x_; }\n  int operator()() const;\n"
                "  template <class T, class U>\n  std::map<T, U> g(T t, U u);\n private:\n"
                "  int x_ = 0, y_{2};\n  std::map<int, std::pair<int, int>> m_;\n"
                "  double a_[3] = {1, 2, 3};\n"
                "  std::function<void(int)> call_;\n  bool (*set_)(int, int) = nullptr;\n};\n")
        self.assertEqual(self.sizes(text), {"A": (7, 6)})

    def test_what_is_no_part_of_an_object_does_not_count(self):
        text = ("struct S {\n  using T = int;\n  static constexpr int k = 3;\n  enum class E { a, b };\n"
                "  struct In {\n    int i;\n    void f();\n  };\n  struct Later;\n  friend class F;\n"
                "  struct { int u; } v;  // int w;\n  E e = E::a;\n};\nenum class X { a };\nstruct Y;\n")
        self.assertEqual(self.sizes(text), {"S": (0, 2), "In": (1, 1)})

    def test_the_list_only_shrinks(self):
        def problems(now, listed):
            return class_size.compare_with(now, listed, 29, "members", "divide it", "list")
        listed = class_size.read_ratchet("# x\n40 a.h A members  # public\n")
        self.assertEqual(listed, {"a.h A members": 40})
        self.assertEqual(problems(listed, listed), [])
        self.assertIn("grew", problems({"a.h A members": 41}, listed)[0])
        self.assertIn("divide it", problems({"b.h B members": 30}, {})[0])
        self.assertIn("lower", problems({"a.h A members": 35}, listed)[0])


class TextRules(unittest.TestCase):
    def test_length_opening_comment_and_places(self):
        self.assertEqual(text_rules.check_text("src/a.cpp", "// What it is for.\nint x;\n"), [])
        self.assertIn("columns", text_rules.check_text("src/a.cpp", "// " + "x" * 108)[0])
        self.assertIn("starts with", text_rules.check_text("src/a.cpp", "int x;\n")[0])
        self.assertIn("<numbers>", text_rules.check_text("src/a.cpp", "// a\nx = M_PI_2;\n")[0])
        for line in ("#include <filesystem>", "std::ifstream in(name);", 'fopen(name, "r");',
                     "std::rename(a, b);"):
            self.assertIn("file_names.h", text_rules.check_text("src/job/a.cpp", f"// a\n{line}\n")[0])
            self.assertEqual(text_rules.check_text("src/base/a.cpp", f"// a\n{line}\n"), [])
        self.assertIn("machine", text_rules.check_text("docs/a.md", "see /" + "work/x\n")[0])
        self.assertEqual(text_rules.check_text("docs/a.md", "a frame/" + "work/x and src/work/y\n"), [])

    def test_links_and_named_documents_exist(self):
        def problems(path, text):
            return text_rules.check_links(path, text, {"docs/a.md", "docs/manual/b.md"}.__contains__)
        self.assertEqual(problems("docs/manual/b.md", "[a](../a.md), [b](b.md#x), [w](https://a.md)"), [])
        self.assertIn("b.md:2: no such document: a.md", problems("docs/manual/b.md", "\n[a](a.md)")[0])
        self.assertEqual(len(problems("src/a.cpp", "// docs/a.md and docs/c.md")), 1)

    def test_a_decision_is_short_and_listed(self):
        page, index = "docs/decisions/1-a.md", "(1-a.md)"
        text = "Status: in force\n"
        self.assertEqual(text_rules.check_decision(page, text + "x\n" * 79, index), [])
        self.assertEqual(len(text_rules.check_decision(page, text + "x\n" * 80, "")), 2)
        self.assertEqual(len(text_rules.check_decision(page, "x\n", index)), 1)

    def test_texts_start_with_a_noun_or_a_verb(self):
        self.assertEqual(len(text_rules.check_text("python/a.py", "    Of the tool, mm.\n")), 1)
        self.assertEqual(len(text_rules.check_text("src/a.cpp", '// a\nadd("of the tool");\n')), 1)
        self.assertEqual(text_rules.check_text("src/a.cpp", '// a\nadd("number of the tool");\n'), [])

    def test_the_root_holds_only_what_is_known(self):
        self.assertEqual(text_rules.stray({"README.md", "dev"}, {"src"}), [])
        self.assertEqual(len(text_rules.stray({"NOTES.md"}, {"scratch"})), 2)


class Codes(unittest.TestCase):
    GOOD = ('KERF_CODE(2001, no_file, "A file is missing.")\n'
            'KERF_CODE(2002, no_feed,\n          "No feed, "\n          "said twice.")\n')

    def check(self, rows, tests):
        return codes.check("gcode", rows, tests, set())

    def test_a_sound_table_passes(self):
        rows = codes.parse(self.GOOD)
        self.assertEqual([row[:2] for row in rows], [(2001, "no_file"), (2002, "no_feed")])
        self.assertEqual(self.check(rows, "codes::no_file codes::no_feed"), [])

    def test_each_fault_is_found(self):
        rows = codes.parse(self.GOOD)
        self.assertIn("no test provokes", self.check(rows, "no_file no_feeder")[0])
        both = "no_file no_feed other"
        self.assertTrue(any("twice" in p for p in self.check(rows + [(2001, "other", '"X."')], both)))
        self.assertTrue(any("outside of the table" in p for p in self.check([(1001, "other", '"X."')], both)))
        self.assertTrue(any("follows" in p for p in self.check(list(reversed(rows)), both)))
        self.assertTrue(codes.check("gcode", rows, both, {"no_feed"}))


class Words(unittest.TestCase):
    def found(self, path, text):
        return [word for _, word, _ in words.offences(path, text)]

    def test_comments_strings_and_documents_are_checked(self):
        self.assertEqual(self.found("src/a.cpp", "// nobody knows\nint x;\n"), ["nobody"])
        self.assertEqual(self.found("src/a.cpp", 'f("is told\\"");\n'), ["told"])
        self.assertEqual(self.found("src/a.cpp", 'f(R"x(tells)x");\n'), ["tells"])
        self.assertEqual(self.found("a.py", '"""It begins\nat 0."""\n'), ["begins"])
        self.assertEqual(self.found("docs/a.md", "Reckoned anew."), ["Reckoned", "anew"])
        self.assertEqual(self.found("dev", "# passed over"), ["passed over"])

    def test_names_are_checked_word_by_word(self):
        self.assertEqual(self.found("a.h", "int kMostSteps = tell_gouge(told_, line_begin);"),
                         ["kMostSteps", "tell_gouge", "told_", "line_begin"])
        self.assertEqual(self.found("a.md", "`kMostSteps` and `most_steps`"), ["kMostSteps", "most_steps"])
        self.assertEqual(self.found("a.h", "std::shared_ptr<A> shared_edge; Operator::at_most; almost;"), [])

    def test_begin_of_a_range_passes(self):
        for text in ("std::sort(a.begin(), b->end());", "auto x = std::begin(a);",
                     "const_iterator begin() const;",
                     "void f(std::size_t begin, std::size_t end);"):
            self.assertEqual(self.found("a.cpp", text), [], text)
        self.assertEqual(self.found("a.cpp", "const Point2 begin = arc.begin;"), ["begin", "begin"])

    def test_correct_english_passes(self):
        for text in ("It cannot be told apart.", "They share an edge.", "Files appear in place.",
                     "Two decimal places.",
                     "It takes place once.", "A stand-in.",
                     "At most 40 lines.", "This is part of it.",
                     "Triangles shared by two tiles"):
            self.assertEqual(self.found("a.md", text), [], text)

    def test_what_is_fixed_passes(self):
        self.assertEqual(words.offences("a.py", 'x["mesh_unsound"]', words.codes_of(words.root_of([]))), [])
        self.assertEqual(self.found("a.py", 'x["road_mm"]'), [])
        self.assertEqual(self.found("CHANGELOG.md", "nobody"), [])
        self.assertEqual(self.found("tests/data/a.nc", "(nobody)"), [])

    def test_lines_are_counted_from_one(self):
        self.assertEqual(words.offences("a.md", "x\nnobody")[0][0], 2)

    def test_a_file_may_have_what_the_list_allows(self):
        allowed = words.read_ratchet("# x\n2 a.cpp\n")
        self.assertEqual(words.compare({"a.cpp": 2}, allowed), [])
        self.assertEqual(words.compare({"a.cpp": 1}, allowed), [])
        self.assertIn("3 banned words, allowed are 2", words.compare({"a.cpp": 3}, allowed)[0])
        self.assertIn("allowed are 0", words.compare({"b.cpp": 1}, allowed)[0])


if __name__ == "__main__":
    unittest.main()
