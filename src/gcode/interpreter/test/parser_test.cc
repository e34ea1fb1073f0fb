// SPDX-License-Identifier: GPL-2.0-or-later
// The tree of one line of text: precedence, and positions of errors.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gcode/syntax/parser.hh"

namespace mw::gcode::detail {
namespace {

/// Trees as text in brackets, operator first. Implemented here, so that no code is shared with the printer.
class Trees {
  public:
    Trees(const Arena &arena, const Names &names) : arena_(arena), names_(names) {}

    std::string str(NodeId id) const {
        const Node &node = arena_.nodes[id];
        switch (node.kind) {
        case NodeKind::NUMBER: return fmt::format("{:g}", node.value);
        case NodeKind::PARAMETER: return fmt::format("(# {})", str(node.a));
        case NodeKind::NAMED: return fmt::format("<{}>", names_.text(node.a));
        case NodeKind::NEGATE: return fmt::format("(neg {})", str(node.a));
        case NodeKind::FUNCTION: return fmt::format("({} {})", FUNCTIONS[node.op], str(node.a));
        case NodeKind::ATAN: return fmt::format("(atan {} {})", str(node.a), str(node.b));
        case NodeKind::BINARY: return fmt::format("({} {} {})", OPERATORS[node.op], str(node.a), str(node.b));
        case NodeKind::EXISTS_NUMBER: return fmt::format("(exists# {})", str(node.a));
        case NodeKind::EXISTS_NAME: return fmt::format("(exists <{}>)", names_.text(node.a));
        }
        return "?";
    }

  private:
    static constexpr const char *OPERATORS[] = {"**", "*",  "/",  "mod", "+",   "-",  "eq", "ne",
                                                "gt", "ge", "lt", "le",  "and", "or", "xor"};
    static constexpr const char *FUNCTIONS[] = {"abs", "acos", "asin",  "cos", "exp",  "fix",
                                                "fup", "ln",   "round", "sin", "sqrt", "tan"};
    const Arena &arena_;
    const Names &names_;
};

struct Line {
    explicit Line(std::string_view text) : block(Parser(arena, names).parse_line(text, 1)) {}

    std::string tree(NodeId id) const { return Trees(arena, names).str(id); }
    bool isRead() const { return block.error == NO_ID; }
    const SyntaxError &error() const { return arena.errors[block.error]; }
    const OWord &oword() const { return arena.owords[block.oword]; }

    Arena arena;
    Names names;
    Block block;
};

/// The tree of an expression, or its error with the column in the expression.
std::string tree_of(const std::string &expression) {
    const std::string before = "#1=[";
    const Line line(before + expression + "]");
    if (!line.isRead()) {
        return fmt::format("{}: {}", line.error().column - before.size(), line.error().message);
    }
    return line.tree(line.arena.settings.at(0).value);
}

std::string repeated(std::string_view text, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) {
        out += text;
    }
    return out;
}

TEST(Parser, OperatorsBindByTheirLevels) {
    const struct {
        const char *text, *tree;
    } cases[] = {
        {"1 + 2 * 3", "(+ 1 (* 2 3))"},
        {"1 * 2 + 3", "(+ (* 1 2) 3)"},
        {"2 * 3 ** 2", "(* 2 (** 3 2))"},
        {"2 ** 3 * 2", "(* (** 2 3) 2)"},
        {"1 + 1 eq 2", "(eq (+ 1 1) 2)"},
        {"2 eq 1 + 1", "(eq 2 (+ 1 1))"},
        {"1 lt 2 and 3 gt 2", "(and (lt 1 2) (gt 3 2))"},
        {"1 or 2 eq 2", "(or 1 (eq 2 2))"},
        {"17 mod 5 - 1", "(- (mod 17 5) 1)"},
        {"1 - 17 mod 5", "(- 1 (mod 17 5))"},
        {"[1 + 2] * 3", "(* (+ 1 2) 3)"},
        {"2 ** [1 + 1]", "(** 2 (+ 1 1))"},
    };
    for (const auto &one : cases) {
        EXPECT_EQ(tree_of(one.text), one.tree) << one.text;
    }
}

TEST(Parser, OperatorsOfOneLevelGoFromLeftToRight) {
    const struct {
        const char *text, *tree;
    } cases[] = {
        {"7 - 3 - 2", "(- (- 7 3) 2)"},
        {"8 / 4 / 2", "(/ (/ 8 4) 2)"},
        {"100 / 10 * 2", "(* (/ 100 10) 2)"},
        {"17 mod 5 * 2", "(* (mod 17 5) 2)"},
        {"2 ** 3 ** 2", "(** (** 2 3) 2)"},
        {"1 or 1 and 0", "(and (or 1 1) 0)"},
        {"1 xor 1 or 1", "(or (xor 1 1) 1)"},
        {"1 lt 2 eq 1", "(eq (lt 1 2) 1)"},
        {"3 gt 2 ge 1 ne 0 le 5", "(le (ne (ge (gt 3 2) 1) 0) 5)"},
    };
    for (const auto &one : cases) {
        EXPECT_EQ(tree_of(one.text), one.tree) << one.text;
    }
}

TEST(Parser, ASignBelongsToTheValueBehindIt) {
    const struct {
        const char *text, *tree;
    } cases[] = {
        {"-2 ** 2", "(** -2 2)"},
        {"-#1 ** 2", "(** (neg (# 1)) 2)"},
        {"2 * -3", "(* 2 -3)"},
        {"2 - -3", "(- 2 -3)"},
        {"2 ** -1", "(** 2 -1)"},
        {"--3", "3"},
        {"-+-#<a>", "(neg (neg <a>))"},
        {"+4", "4"},
        {"-[1 + 2]", "(neg (+ 1 2))"},
        {"-fix[2.8]", "(neg (fix 2.8))"},
        {"#-1", "(# -1)"},
    };
    for (const auto &one : cases) {
        EXPECT_EQ(tree_of(one.text), one.tree) << one.text;
    }
}

TEST(Parser, FunctionsTakeBracketsAndAtanTwo) {
    EXPECT_EQ(tree_of("atan[1]/[-1] + 1"), "(+ (atan 1 -1) 1)");
    EXPECT_EQ(tree_of("2 * atan[1 + 1]/[#2] / 3"), "(/ (* 2 (atan (+ 1 1) (# 2))) 3)");
    EXPECT_EQ(tree_of("sin[cos[1]]"), "(sin (cos 1))");
    EXPECT_EQ(tree_of("exists[#<a b>]"), "(exists <ab>)");
    EXPECT_EQ(tree_of("exists[#5]"), "(exists# 5)");
    for (const char *name :
         {"abs", "acos", "asin", "cos", "exp", "fix", "fup", "ln", "round", "sin", "sqrt", "tan"}) {
        EXPECT_EQ(tree_of(std::string(name) + "[1]"), fmt::format("({} 1)", name));
    }
}

TEST(Parser, CaseAndBlanksMeanNothing) {
    EXPECT_EQ(tree_of("1 M o D 2"), "(mod 1 2)");
    EXPECT_EQ(tree_of("a B s [ - 1 . 5 ]"), "(abs -1.5)");
    EXPECT_EQ(tree_of("2 * * 3"), "(** 2 3)");
    EXPECT_EQ(tree_of("#<My Name>"), "<myname>");
    EXPECT_EQ(tree_of("#<_hal[My.Pin]>"), "<_hal[My.Pin]>");
}

TEST(Parser, ParametersMayNameParameters) {
    EXPECT_EQ(tree_of("##2"), "(# (# 2))");
    EXPECT_EQ(tree_of("#[1 + #2]"), "(# (+ 1 (# 2)))");
    EXPECT_EQ(tree_of("#1 + 1"), "(+ (# 1) 1)") << "a parameter's number is one value";
    EXPECT_EQ(tree_of("#2 ** 2"), "(** (# 2) 2)");
}

TEST(Parser, NestingIsBounded) {
    constexpr int MOST = 128;
    for (const char *opener : {"[", "-", "#"}) {
        const bool is_bracket = opener[0] == '[';
        const auto nested = [&](int depth) {
            return "#1=" + repeated(opener, depth) + "1" + (is_bracket ? repeated("]", depth) : "");
        };
        // The innermost number is a value, too.
        EXPECT_TRUE(Line(nested(MOST - 1)).isRead()) << opener;
        const Line deep(nested(MOST));
        ASSERT_FALSE(deep.isRead()) << opener;
        EXPECT_EQ(deep.error().message, "The expression is nested too deeply") << opener;
        EXPECT_FALSE(Line(nested(100000)).isRead()) << opener;
    }
    Arena arena;
    Names names;
    Parser parser(arena, names);
    parser.parse_line("#1=" + repeated("[", 300) + "1", 1);
    EXPECT_EQ(parser.parse_line("#1=[[1]]", 2).error, NO_ID) << "depth is counted separately for each line";
}

TEST(Parser, ALineHasAMostOfOperators) {
    constexpr int MOST = 1000;
    EXPECT_TRUE(Line("#1=[1" + repeated("+1", MOST) + "]").isRead());
    EXPECT_TRUE(Line("#1=[1" + repeated("+1", MOST / 2) + "] x[1" + repeated("*1", MOST / 2) + "]").isRead());
    const Line longer("#1=[1" + repeated("+1", MOST + 1) + "]");
    ASSERT_FALSE(longer.isRead());
    EXPECT_EQ(longer.error().message, "A line has at most 1000 operators: divide it into several lines");
    EXPECT_EQ(longer.error().column, 2U * MOST + 6);
    EXPECT_FALSE(Line("#1=[1" + repeated("+1", 5'000'000) + "]").isRead());
}

TEST(Parser, ErrorsNameTheirColumn) {
    const struct {
        const char *line;
        std::uint32_t column;
        const char *message;
    } cases[] = {
        {"#1=[1 + 2", 10, "Unclosed expression"},
        {"#1=[1 & 2]", 7, "Unknown operation"},
        {"#1=[1 2 + 3,]", 12, "Unknown operation"},
        {"#1 X3", 4, "Equal sign missing in parameter setting"},
        {"#<abc=1", 1, "Named parameter not terminated"},
        {"G1 X", 5, "No characters found in reading real value"},
        {"G1 X[foo[1]]", 6, "Unknown word starting with f"},
        {"G1 X sin 1", 10, "Left bracket missing after unary operation name"},
        {"G1 X[atan[1][2]]", 13, "Slash missing after first atan argument"},
        {"G1 X[atan[1]/2]", 14, "Left bracket missing after slash with atan"},
        {"G1 X[exists[5]]", 13, "Expected # reading parameter"},
        {"G1 X1 X2", 7, "Multiple x words on one line"},
        {"G1 (a (b) c)", 4, "Nested comment found"},
        {"G1 (a", 4, "Unclosed comment found"},
        {"G1 O5 sub", 4, "An O word must be first on its line"},
        {"O5 if 1", 7, "Expected [ and a condition or count after the O word"},
        {"O5 sub 3", 8, "Only a comment may follow here"},
        {"N-1 G1", 1, "N needs a number that is not negative and at most 2147483647"},
    };
    for (const auto &one : cases) {
        const Line line(one.line);
        ASSERT_FALSE(line.isRead()) << one.line;
        EXPECT_EQ(line.error().message, one.message) << one.line;
        EXPECT_EQ(line.error().column, one.column) << one.line;
    }
}

TEST(Parser, ALineHasWordsSettingsAndComments) {
    const Line line("/N12 G1 X-2.5 Y[1+1] #3=4 (one) #<a>=5 Z#3 (two)");
    ASSERT_TRUE(line.isRead());
    EXPECT_TRUE(line.block.deletable);
    EXPECT_TRUE(line.block.isNumbered);
    EXPECT_EQ(line.block.sequence, 12);
    ASSERT_EQ(line.block.word_count, 4);
    const Word &x = line.arena.words[1];
    EXPECT_EQ(x.letter, letter('x'));
    EXPECT_EQ(x.value, -2.5);
    EXPECT_EQ(x.expression, NO_ID);
    EXPECT_EQ(x.column, 9u);
    EXPECT_EQ(line.tree(line.arena.words[2].expression), "(+ 1 1)");
    EXPECT_EQ(line.tree(line.arena.words[3].expression), "(# 3)");
    ASSERT_EQ(line.block.setting_count, 2);
    EXPECT_EQ(line.tree(line.arena.settings[0].index), "3");
    EXPECT_EQ(line.names.text(line.arena.settings[1].name), "a");
    ASSERT_EQ(line.block.comment_count, 2);
    EXPECT_TRUE(Line("%").block.is_percent);
    EXPECT_EQ(Line("").block.word_count, 0);
}

TEST(Parser, OWordsKnowTheirKindsLabelsAndValues) {
    const struct {
        const char *text;
        OKind kind;
    } kinds[] = {
        {"o1 sub", OKind::SUB},
        {"o1 endsub", OKind::ENDSUB},
        {"o1 call", OKind::CALL},
        {"o1 return", OKind::RETURN},
        {"o1 if [1]", OKind::IF},
        {"o1 elseif [1]", OKind::ELSEIF},
        {"o1 else", OKind::ELSE},
        {"o1 endif", OKind::ENDIF},
        {"o1 while [1]", OKind::WHILE},
        {"o1 endwhile", OKind::ENDWHILE},
        {"o1 do", OKind::DO},
        {"o1 repeat [2]", OKind::REPEAT},
        {"o1 endrepeat", OKind::ENDREPEAT},
        {"o1 break", OKind::BREAK},
        {"o1 continue", OKind::CONTINUE},
        {"o1", OKind::FANUC},
    };
    for (const auto &one : kinds) {
        const Line line(one.text);
        ASSERT_TRUE(line.isRead()) << one.text;
        EXPECT_EQ(line.oword().kind, one.kind) << one.text;
        EXPECT_EQ(line.names.text(line.oword().label), "1") << one.text;
    }
    const Line call("O<My Sub> call [1+2] [#3] (x) [4]");
    ASSERT_TRUE(call.isRead());
    EXPECT_EQ(call.names.text(call.oword().label), "mysub");
    ASSERT_EQ(call.oword().argument_count, 3u);
    EXPECT_EQ(call.tree(call.arena.arguments[0]), "(+ 1 2)");
    EXPECT_EQ(call.tree(call.arena.arguments[2]), "4");
    const Line computed("o[#1+1] call");
    ASSERT_TRUE(computed.isRead());
    EXPECT_EQ(computed.oword().label, NO_ID);
    EXPECT_EQ(computed.tree(computed.oword().label_expression), "(+ (# 1) 1)");
    const Line returned("o1 endsub [7]");
    EXPECT_EQ(returned.tree(returned.oword().value), "7");
}

TEST(Names, ATextHasOneNumberThatStays) {
    Names names;
    const NameId first = names.intern("x0");
    for (int i = 1; i < 1000; ++i) {
        EXPECT_EQ(names.intern(fmt::format("x{}", i)), static_cast<NameId>(i));
    }
    EXPECT_EQ(names.intern("x0"), first);
    EXPECT_EQ(names.text(first), "x0");
    EXPECT_EQ(names.size(), 1000u);
    EXPECT_NE(names.intern("X0"), first) << "case is folded by the reader, not here";
}

}  // namespace
}  // namespace mw::gcode::detail
