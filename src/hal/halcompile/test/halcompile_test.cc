// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "base/diagnostics/sink.hh"
#include "hal/halcompile/checker.hh"
#include "hal/halcompile/code.hh"
#include "hal/halcompile/emit_c.hh"
#include "hal/halcompile/emit_man.hh"
#include "hal/halcompile/object_file.hh"
#include "hal/halcompile/parser.hh"
#include "hal/halcompile/program.hh"
#include "hal/halcompile/toolchain.hh"

namespace mw::halcompile {
namespace {

Component parse_good(const std::string &text) {
    diagnostics::Sink sink;
    Component component = parse(text, "x.comp", sink);
    EXPECT_FALSE(sink.hasErrors()) << sink.all().front().str();
    return component;
}

/// "line:column message" of each error, in order.
std::vector<std::string> errors_of(const std::string &text) {
    diagnostics::Sink sink;
    const Component component = parse(text, "x.comp", sink);
    if (!sink.hasErrors()) {
        check(component, "x", sink);
    }
    std::vector<std::string> errors;
    for (const diagnostics::Diagnostic &one : sink.all()) {
        if (one.severity == diagnostics::Severity::ERROR) {
            errors.push_back(std::to_string(one.what.place.line) + ":" +
                             std::to_string(one.what.place.column) + " " + one.what.message);
        }
    }
    return errors;
}

using Texts = std::vector<std::string>;
const std::string TAIL = "\nfunction _; license \"GPL\";\n;;\n";

TEST(HalcompileNames, FollowTheRules) {
    EXPECT_EQ(c_name("x-y.z"), "x_y_z");
    EXPECT_EQ(c_name("x.##.y"), "x_y");
    EXPECT_EQ(c_name("x.##"), "x");
    EXPECT_EQ(c_name("out-#"), "out");
    EXPECT_EQ(c_name("x_y_z_"), "x_y_z_");
    EXPECT_EQ(c_name("a-_b"), "a_b");
    EXPECT_EQ(hal_name("x_y_z_"), "x-y-z");
    EXPECT_EQ(hal_name("x-y.z"), "x-y.z");
    EXPECT_EQ(hal_name("_"), "");
    Component component;
    component.name = "hal_loop";
    EXPECT_EQ(hal_prefix(component), "loop");
}

TEST(HalcompileParser, ReadsEveryKindOfItem) {
    const Component c = parse_good(R"(component x "doc";
/* pins */ pin in bit a; // first
pin out float out-## [16 : personality & 0xff] if personality >= 2 = 1.5 "text";
pin io signed io_ = -3;
param rw unsigned p = 0x7FFFFFFF r"\fIraw\fR";
param r s64 big-#[4];
function read nofp "reads";
function _ fp;
license "GPL"; author "A"; author "B";
;;
code)");
    ASSERT_EQ(c.items.size(), 5U);
    EXPECT_EQ(c.items[1].array->size, "16");
    EXPECT_EQ(c.items[1].array->count, "personality & 0xff");
    EXPECT_EQ(c.items[1].condition, "personality >= 2");
    EXPECT_EQ(c.items[1].start_value, "1.5");
    EXPECT_EQ(c.items[2].start_value, "-3");
    EXPECT_EQ(c.items[3].doc, "\\fIraw\\fR");
    EXPECT_EQ(c.items[4].direction, Direction::RO);
    ASSERT_EQ(c.functions.size(), 2U);
    EXPECT_FALSE(c.functions[0].usesFloat);
    EXPECT_EQ(c.functions[0].doc, "reads");
    EXPECT_EQ(c.authors.size(), 2U);
    EXPECT_TRUE(c.hasPersonality());
    EXPECT_EQ(c.code, "\ncode");
    EXPECT_EQ(c.code_line, 10);
}

TEST(HalcompileParser, ReadsCDeclarations) {
    const Component c = parse_good(R"(component x;
include "my.h"; include <sys/io.h>;
struct pair { int a; struct { double b; } in; };
typedef struct { int n; } count_t;
typedef int number_t;
variable int *pointer;
variable unsigned long long wide = 7;
variable struct pair pairs[2][3];
variable double table[3] = {1, 2, 3};
modparam int level = 3 "how many";
modparam string file = "a;b" "a name";
modparam int list[8];
modparam dummy other "declared in the code";
option data my_type; option extra_link_args "-lfoo -L.";
license "GPL";
;;)");
    EXPECT_EQ(c.includes[0].text, "\"my.h\"");
    EXPECT_EQ(c.includes[1].text, "<sys/io.h>");
    EXPECT_EQ(c.structures[0].text, "struct pair { int a; struct { double b; } in; };");
    EXPECT_EQ(c.structures[1].text, "typedef struct { int n; } count_t;");
    EXPECT_EQ(c.structures[2].text, "typedef int number_t;");
    EXPECT_EQ(c.variables[0].stars, "*");
    EXPECT_EQ(c.variables[1].type, "unsigned long long");
    EXPECT_EQ(c.variables[2].type, "struct pair");
    EXPECT_EQ(c.variables[2].size, "2][3");
    EXPECT_EQ(c.variables[3].start_value, "{1, 2, 3}");
    EXPECT_EQ(c.parameters[0].start_value, "3");
    EXPECT_EQ(c.parameters[1].start_value, "a;b");
    EXPECT_EQ(c.parameters[1].doc, "a name");
    EXPECT_EQ(c.parameters[2].size, "8");
    EXPECT_EQ(c.option("data")->value, "my_type");
    EXPECT_EQ(c.option("extra_link_args")->value, "-lfoo -L.");
}

TEST(HalcompileParser, ResolvesStrings) {
    const Component c = parse_good("component x \"a\\tb\\\\fI\\(bu\\x41\\101\";\n"
                                   "description \"\"\"two\nlines \"quoted\".\"\"\";\nlicense \"G\";\n;;");
    EXPECT_EQ(c.doc, "a\tb\\fI\\(buAA");
    EXPECT_EQ(c.description->text, "two\nlines \"quoted\".");
}

TEST(HalcompileParser, GoesOnAfterErrors) {
    EXPECT_EQ(
        errors_of("component x \"a;\npin in flot a;\npn in bit b;\npin sideways bit c;\nfunction _\nlicense "
                  "\"GPL\";\n;;\n"),
        (Texts{"1:13 this string has no closing quote", "2:8 'flot' is not a HAL type",
               "3:1 'pn' is not a declaration", "4:5 'sideways' is not a direction of a pin",
               "6:1 ';' is expected before 'license'"}));
    EXPECT_EQ(errors_of("component x;\npin in bit a-#[3;\n/* no end").size(), 2U);
    EXPECT_EQ(errors_of("component x;\npin in bit a if (personality & 1;" + TAIL).size(), 1U);
}

TEST(HalcompileParser, RejectsConditionsInTheWrongOrder) {
    const Texts at_if{"2:18 ';' is expected before 'if'"};
    EXPECT_EQ(errors_of("component x;\npin in bit a = 1 if personality & 1;" + TAIL), at_if);
    EXPECT_EQ(errors_of("component x;\nparam rw s32 a=1 if (personality);" + TAIL), at_if);
    EXPECT_EQ(errors_of("component x;\npin in bit a if 1\nif personality;" + TAIL),
              (Texts{"3:1 ';' is expected before 'if'"}));
    EXPECT_EQ(errors_of("component x;\nmodparam int a=1 if 2;" + TAIL), at_if);
    EXPECT_EQ(errors_of("component x;\npin out float a if personality = 2 \"b\" if c;" + TAIL).size(), 1U);
    EXPECT_TRUE(
        errors_of("component x;\npin in s32 a if(personality) = iff;\npin in bit b if\npersonality;" + TAIL)
            .empty());
}

TEST(HalcompileChecker, FindsWhatCannotWork) {
    EXPECT_EQ(errors_of("component y;" + TAIL), (Texts{"1:1 component 'y' is in a file named x"}));
    EXPECT_EQ(errors_of("component x;\npin in bit a;\npin out bit a;" + TAIL),
              (Texts{"3:1 the name 'a' is already in use"}));
    EXPECT_EQ(errors_of("component x;\npin in bit if;" + TAIL), (Texts{"2:1 'if' is a C keyword"}));
    EXPECT_EQ(errors_of("component x;\nvariable int fperiod;" + TAIL),
              (Texts{"2:1 the name 'fperiod' is reserved"}));
    EXPECT_EQ(errors_of("component x;\npin in bit a-#;" + TAIL), (Texts{"2:1 'a-#' has # but no [SIZE]"}));
    EXPECT_EQ(errors_of("component x;\npin in bit a[2];" + TAIL), (Texts{"2:1 'a' has a [SIZE] but no #"}));
    EXPECT_EQ(errors_of("component x;\npin in bit a = 2;" + TAIL), (Texts{"2:1 'a' starts with 2"}));
    EXPECT_EQ(errors_of("component x;\npin in s32 a = 0.5;" + TAIL), (Texts{"2:1 'a' starts with 0.5"}));
    EXPECT_EQ(errors_of("component x;\noption singleton maybe;" + TAIL),
              (Texts{"2:1 option singleton is 'maybe'"}));
    EXPECT_EQ(
        errors_of(
            "component x;\nfunction a;\nfunction b;\nlicense \"G\";\n;;\nFUNCTION(a) {}\n FUNCTION(c) {}"),
        (Texts{"3:1 function 'b' is not defined", "7:2 FUNCTION(c) is not declared"}));
    EXPECT_EQ(errors_of("component x;\noption userspace;\nfunction _; license \"G\";\n;;user_mainloop"),
              (Texts{"3:1 a userspace component has no functions"}));
    EXPECT_EQ(errors_of("component x; license \"G\";"), (Texts{"0:0 there is no ;;"}));
}

TEST(HalcompileChecker, WantsTheCodeThatOptionsCall) {
    EXPECT_EQ(errors_of("component x;\noption userspace;\nlicense \"G\";\n;;\nint user_main;"),
              (Texts{"2:1 option userspace is on, but there is no user_mainloop"}));
    EXPECT_EQ(errors_of("component x;\noption extra_setup;" + TAIL + "// EXTRA_SETUP"),
              (Texts{"2:1 option extra_setup is on, but there is no EXTRA_SETUP"}));
    EXPECT_EQ(errors_of("component x;\noption rtapi_app no;" + TAIL),
              (Texts{"2:1 option rtapi_app is off, but there is no rtapi_app_main"}));
    EXPECT_EQ(errors_of("component x;\noption extra_setup;" + TAIL + "#include \"setup.c\""), Texts{});
    EXPECT_EQ(errors_of("component x;\nfunction _; license \"G\"\n;;\n"),
              (Texts{"3:1 ';' is expected here"}));
}

TEST(HalcompileChecker, ReservesNamesOnlyWhereTheyAreSeen) {
    EXPECT_EQ(errors_of("\xef\xbb\xbf"
                        "component x;\r\npin in bit prefix;\r\npin in bit export;" +
                        TAIL),
              Texts{});
    EXPECT_EQ(errors_of("component x;\noption extra_setup;\npin in bit prefix;" + TAIL + "EXTRA_SETUP"),
              (Texts{"3:1 the name 'prefix' is reserved"}));
}

TEST(HalcompileCode, SeesFunctionsOnlyInCode) {
    const CodeFacts facts =
        look_at_code("// FUNCTION(a)\n\"FUNCTION(b)\" FUNCTION (c) { '\"' }\n#include \"f.h\"\n");
    ASSERT_EQ(facts.functions.size(), 1U);
    EXPECT_EQ(facts.functions[0].name, "c");
    EXPECT_EQ(facts.functions[0].line, 1);
    EXPECT_TRUE(facts.has_quoted_include);
    EXPECT_FALSE(look_at_code("/* FUNCTION(_) */").has_function_word);
}

TEST(HalcompileCode, FindsWhereTheNestingIsDeeperThanCompilersTake) {
    const std::string sound =
        std::string(200, '(') + std::string(200, ')') + "/*" + std::string(300, '{') + "*/";
    EXPECT_FALSE(look_at_code(sound + "- - !x").deep.has_value());
    const auto deep = look_at_code("FUNCTION(_)\n" + std::string(300, '{')).deep;
    ASSERT_TRUE(deep.has_value());
    EXPECT_EQ(deep->line, 1);
    EXPECT_EQ(deep->column, 257);
    EXPECT_TRUE(look_at_code(std::string(300, '-')).deep.has_value());
}

TEST(HalcompileEmit, WrapsABodyAndKeepsItsLines) {
    const std::string c =
        emit_c(parse_good("component x;\npin in float in;\nfunction _;\nlicense \"GPL\";\n;;\nbody;\n"));
    EXPECT_NE(c.find("FUNCTION(_) {\n#line 5 \"x.comp\"\n\nbody;\n"), std::string::npos) << c;
    EXPECT_NE(c.find("MODULE_LICENSE(\"GPL\");"), std::string::npos);
}

TEST(HalcompileEmit, WritesThePageInTroff) {
    const std::string page = emit_man(parse_good(R"C(component x "one thing";
pin in bit in-##[16 : personality] "inputs"; param rw float gain = 1.5;
function do_it "acts"; license "GPL"; author "Me"; see_also "\\fIother\\fR(9)";
;;)C"));
    EXPECT_NE(page.find("x \\- one thing\n"), std::string::npos) << page;
    EXPECT_NE(page.find("\\fBx.N.in\\-MM\\fR bit in (\\fIMM\\fR = 00 to 15), the first personality of them"),
              std::string::npos)
        << page;
    EXPECT_NE(page.find("\\fBx.N.gain\\fR float rw (default: \\fI1.5\\fR)"), std::string::npos) << page;
    EXPECT_NE(page.find(".B x.N.do\\-it\nacts"), std::string::npos) << page;
    EXPECT_NE(page.find(".SH SEE ALSO\n\\fIother\\fR(9)"), std::string::npos) << page;
}

TEST(HalcompileOptions, TakeTheManualsForms) {
    const auto options =
        parse_options({"--personality=128", "--install", "--extra-link-args=-L'a b' -lc", "x.comp"});
    ASSERT_TRUE(options) << options.error().str();
    EXPECT_EQ(options->personalities, 128);
    EXPECT_EQ(options->link_args, (Texts{"-La b", "-lc"}));
    EXPECT_FALSE(parse_options({"--p"})) << "ambiguous";
    EXPECT_FALSE(parse_options({"--e=1"})) << "ambiguous";
    EXPECT_EQ(parse_options({"--install", "a.c"})->mode, Mode::INSTALL);
    EXPECT_EQ(parse_options({"-cu", "a.c"})->userspace, true);
}

TEST(HalcompileObject, RefusesOtherFiles) {
    EXPECT_FALSE(look_at_object("no elf", "x"));
    EXPECT_FALSE(look_at_object(std::string("\177ELF\2\1\1") + std::string(80, '\377'), "x"));
}

}  // namespace
}  // namespace mw::halcompile
