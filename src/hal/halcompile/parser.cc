// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/parser.hh"

#include <array>
#include <utility>

#include <fmt/core.h>

#include "base/diagnostics/message_limit.hh"
#include "base/text.hh"
#include "hal/halcompile/c_declaration.hh"
#include "hal/halcompile/scanner.hh"

namespace mw::halcompile {
namespace {

struct TypeName {
    std::string_view word;
    ValueType type;
};
constexpr std::array<TypeName, 16> TYPES{{{"bit", ValueType::BIT},
                                          {"float", ValueType::FLOAT},
                                          {"s32", ValueType::S32},
                                          {"u32", ValueType::U32},
                                          {"s64", ValueType::S64},
                                          {"u64", ValueType::U64},
                                          {"signed", ValueType::S32},
                                          {"unsigned", ValueType::U32},
                                          {"port", ValueType::PORT},
                                          {"bool", ValueType::BIT},
                                          {"real", ValueType::FLOAT},
                                          {"sint", ValueType::S64},
                                          {"uint", ValueType::U64},
                                          {"double", ValueType::FLOAT},
                                          {"si32", ValueType::S32},
                                          {"ui32", ValueType::U32}}};

class Parser {
  public:
    Parser(std::string_view text, const std::string &file, diagnostics::Sink &sink)
        : text_(text), scanner_(text, file), sink_(sink) {
        component_.file = file;
    }

    Component run() {
        while (true) {
            if (!scanner_.skip_blank()) {
                sink_.error("this comment has no end", scanner_.place(), "it needs a closing */");
            }
            if (scanner_.isAtEnd()) {
                return std::move(component_);
            }
            if (scanner_.accept(";;")) {
                take_code();
                return std::move(component_);
            }
            if (auto done = declaration(); !done) {
                sink_.error(done.error());
                if (sink_.all().size() >= diagnostics::MOST_OF_A_FILE) {
                    sink_.error("too many wrong declarations: the rest is not read", scanner_.place());
                    return std::move(component_);
                }
                scanner_.skip_declaration(&Parser::isStart);
            }
        }
    }

  private:
    using Handler = Result<> (Parser::*)(SourcePlace);
    struct Rule {
        std::string_view word;
        Handler handler;
    };

    static const std::array<Rule, 17> &rules() {
        static constexpr std::array<Rule, 17> RULES{{{"component", &Parser::component},
                                                     {"pin", &Parser::pin},
                                                     {"param", &Parser::param},
                                                     {"function", &Parser::function},
                                                     {"option", &Parser::option},
                                                     {"variable", &Parser::variable},
                                                     {"modparam", &Parser::modparam},
                                                     {"include", &Parser::include},
                                                     {"struct", &Parser::structure},
                                                     {"typedef", &Parser::type_definition},
                                                     {"description", &Parser::description},
                                                     {"examples", &Parser::examples},
                                                     {"notes", &Parser::notes},
                                                     {"see_also", &Parser::see_also},
                                                     {"license", &Parser::license},
                                                     {"author", &Parser::author},
                                                     {"authors", &Parser::author}}};
        return RULES;
    }

    /// True for a line that begins a declaration or the code.
    static bool isStart(std::string_view line) {
        if (line.starts_with(";;")) {
            return true;
        }
        for (const Rule &rule : rules()) {
            const bool is_word = line.starts_with(rule.word) && line.size() > rule.word.size() &&
                                 (line[rule.word.size()] == ' ' || line[rule.word.size()] == '\t');
            if (is_word) {
                return true;
            }
        }
        return false;
    }

    Result<> declaration() {
        const SourcePlace place = scanner_.place();
        const std::string word = scanner_.take_name();
        for (const Rule &rule : rules()) {
            if (rule.word == word) {
                scanner_.skip_blank();
                return (this->*rule.handler)(place);
            }
        }
        std::vector<std::string> known;
        for (const Rule &rule : rules()) {
            known.emplace_back(rule.word);
        }
        const std::string near = nearest_name(word, known);
        return fail(word.empty() ? std::string("a declaration is expected here")
                                 : fmt::format("'{}' is not a declaration", word),
                    place,
                    near.empty() ? "put ;; on a separate line before the code"
                                 : fmt::format("did you mean '{}'?", near));
    }

    /// Reads the end of a declaration.
    Result<> end() {
        scanner_.skip_blank();
        const bool is_code_mark = scanner_.isNext(";;") && scanner_.place().column == 1;
        if (!is_code_mark && scanner_.accept(";")) {
            return {};
        }
        return fail("';' is expected here", scanner_.place(), "it ends the previous declaration");
    }

    Result<std::string> optional_doc() {
        scanner_.skip_blank();
        return scanner_.isAtString() ? scanner_.take_string() : Result<std::string>(std::string());
    }

    Result<std::string> name(const char *what) {
        std::string word = scanner_.take_hal_name();
        scanner_.skip_blank();
        if (word.empty()) {
            return fail(fmt::format("the name of the {} is expected here", what), scanner_.place());
        }
        return word;
    }

    Result<> component(SourcePlace place) {
        auto word = name("component");
        if (!word) {
            return std::unexpected(word.error());
        }
        auto doc = optional_doc();
        if (!doc) {
            return std::unexpected(doc.error());
        }
        if (!component_.name.empty()) {
            return fail("there is a 'component' already", place, "a file can describe only one component");
        }
        component_.place = std::move(place);
        component_.name = std::move(*word);
        component_.doc = std::move(*doc);
        return end();
    }

    Result<> direction(Item &item) {
        const SourcePlace place = scanner_.place();
        const std::string word = scanner_.take_name();
        scanner_.skip_blank();
        static constexpr std::array<std::pair<std::string_view, Direction>, 5> WORDS{{{"in", Direction::IN},
                                                                                      {"out", Direction::OUT},
                                                                                      {"io", Direction::IO},
                                                                                      {"r", Direction::RO},
                                                                                      {"rw", Direction::RW}}};
        for (const auto &[text, direction] : WORDS) {
            const bool of_pin =
                direction == Direction::IN || direction == Direction::OUT || direction == Direction::IO;
            if (text == word && of_pin == item.isPin) {
                item.direction = direction;
                return {};
            }
        }
        return fail(fmt::format("'{}' is not a direction of a {}", word, item.isPin ? "pin" : "parameter"),
                    place, item.isPin ? "use in, out or io" : "use r or rw");
    }

    Result<> type(Item &item) {
        const SourcePlace place = scanner_.place();
        const std::string word = scanner_.take_name();
        scanner_.skip_blank();
        for (const TypeName &known : TYPES) {
            if (known.word == word) {
                item.type = known.type;
                return {};
            }
        }
        return fail(fmt::format("'{}' is not a HAL type", word), place,
                    "use bit, float, signed (s32), unsigned (u32), s64, u64 or port");
    }

    Result<> array(std::optional<ArraySize> &array) {
        if (!scanner_.accept("[")) {
            return {};
        }
        scanner_.skip_blank();
        auto size = scanner_.take_expression(":]");
        if (!size) {
            return std::unexpected(size.error());
        }
        ArraySize found{std::move(*size), {}};
        if (scanner_.accept(":")) {
            scanner_.skip_blank();
            auto count = scanner_.take_expression("]");
            if (!count) {
                return std::unexpected(count.error());
            }
            found.count = std::move(*count);
        }
        scanner_.accept("]");
        scanner_.skip_blank();
        array = std::move(found);
        return {};
    }

    /// A condition or a start value, without the word 'if'.
    Result<std::string> expression(std::string_view stops) {
        constexpr std::string_view IF = "if";
        auto text = scanner_.take_expression(stops, IF);
        if (text && scanner_.isWord(IF)) {
            return fail("';' is expected before 'if'", scanner_.place(),
                        "write one condition before the start value: pin in bit NAME if CONDITION = VALUE");
        }
        return text;
    }

    /// Reads "if CONDITION", "= VALUE" and the text, each optional.
    Result<> item_tail(Item &item) {
        if (scanner_.isWord("if")) {
            scanner_.accept("if");
            scanner_.skip_blank();
            auto condition = expression("=\";");
            if (!condition) {
                return std::unexpected(condition.error());
            }
            if (condition->empty()) {
                return fail("a condition is expected after 'if'", scanner_.place());
            }
            item.condition = std::move(*condition);
        }
        auto value = start_value();
        if (!value) {
            return std::unexpected(value.error());
        }
        item.start_value = std::move(*value);
        auto doc = optional_doc();
        if (!doc) {
            return std::unexpected(doc.error());
        }
        item.doc = std::move(*doc);
        return {};
    }

    Result<std::string> start_value() {
        scanner_.skip_blank();
        if (!scanner_.accept("=")) {
            return std::string();
        }
        scanner_.skip_blank();
        auto value = expression("\";");
        if (value && value->empty()) {
            return fail("a value is expected after '='", scanner_.place());
        }
        return value;
    }

    Result<> item(SourcePlace place, bool is_pin) {
        Item item;
        item.isPin = is_pin;
        item.place = std::move(place);
        if (auto done = direction(item); !done) {
            return done;
        }
        if (auto done = type(item); !done) {
            return done;
        }
        auto word = name(is_pin ? "pin" : "parameter");
        if (!word) {
            return std::unexpected(word.error());
        }
        item.name = std::move(*word);
        if (auto done = array(item.array); !done) {
            return done;
        }
        if (auto done = item_tail(item); !done) {
            return done;
        }
        component_.items.push_back(std::move(item));
        return end();
    }

    Result<> pin(SourcePlace place) { return item(std::move(place), true); }
    Result<> param(SourcePlace place) { return item(std::move(place), false); }

    Result<> function(SourcePlace place) {
        Function function;
        function.place = std::move(place);
        auto word = name("function");
        if (!word) {
            return std::unexpected(word.error());
        }
        function.name = std::move(*word);
        const SourcePlace kind_place = scanner_.place();
        const std::string kind = scanner_.isAtString() ? std::string() : scanner_.take_name();
        if (!kind.empty() && kind != "fp" && kind != "nofp") {
            return fail(fmt::format("';' is expected before '{}'", kind), kind_place,
                        "after the function name: fp or nofp, a text, and ;");
        }
        function.usesFloat = kind != "nofp";
        auto doc = optional_doc();
        if (!doc) {
            return std::unexpected(doc.error());
        }
        function.doc = std::move(*doc);
        component_.functions.push_back(std::move(function));
        return end();
    }

    Result<> option(SourcePlace place) {
        Option option;
        option.place = std::move(place);
        auto word = name("option");
        if (!word) {
            return std::unexpected(word.error());
        }
        option.name = std::move(*word);
        if (scanner_.isAtString()) {
            auto text = scanner_.take_string();
            if (!text) {
                return std::unexpected(text.error());
            }
            option.value = std::move(*text);
        } else {
            auto text = scanner_.take_expression(";");
            if (!text) {
                return std::unexpected(text.error());
            }
            option.value = text->empty() ? "yes" : std::move(*text);
        }
        component_.options.push_back(std::move(option));
        return end();
    }

    Result<> variable(SourcePlace place) {
        Variable variable;
        variable.place = std::move(place);
        auto head = take_c_declaration(scanner_);
        if (!head) {
            return std::unexpected(head.error());
        }
        variable.type = std::move(head->type);
        variable.stars = std::move(head->stars);
        variable.name = std::move(head->name);
        variable.size = std::move(head->size);
        if (scanner_.accept("=")) {
            scanner_.skip_blank();
            auto value = scanner_.take_expression(";");
            if (!value) {
                return std::unexpected(value.error());
            }
            variable.start_value = std::move(*value);
        }
        component_.variables.push_back(std::move(variable));
        return end();
    }

    Result<> modparam(SourcePlace place) {
        ModuleParameter parameter;
        parameter.place = std::move(place);
        auto head = take_c_declaration(scanner_);
        if (!head) {
            return std::unexpected(head.error());
        }
        parameter.type = head->type + head->stars;
        parameter.name = std::move(head->name);
        parameter.size = std::move(head->size);
        const bool is_string = parameter.type == "string" || parameter.type == "char*";
        if (is_string && scanner_.accept("=")) {
            scanner_.skip_blank();
            auto text = scanner_.take_string();
            if (!text) {
                return std::unexpected(text.error());
            }
            parameter.start_value = std::move(*text);
        } else if (!is_string) {
            auto value = start_value();
            if (!value) {
                return std::unexpected(value.error());
            }
            parameter.start_value = std::move(*value);
        }
        auto doc = optional_doc();
        if (!doc) {
            return std::unexpected(doc.error());
        }
        parameter.doc = std::move(*doc);
        component_.parameters.push_back(std::move(parameter));
        return end();
    }

    Result<> include(SourcePlace place) {
        if (scanner_.accept("<")) {
            const auto file = scanner_.take_until('>');
            if (!file) {
                return fail("this '<' has no '>'", std::move(place));
            }
            component_.includes.push_back({std::move(place), "<" + *file + ">"});
            return end();
        }
        const auto file = scanner_.take_string();
        if (!file) {
            return fail("a header in quotes or angle brackets is expected here", scanner_.place());
        }
        component_.includes.push_back({std::move(place), "\"" + *file + "\""});
        return end();
    }

    Result<> structure(SourcePlace place) { return definition(std::move(place), take_struct(scanner_)); }
    Result<> type_definition(SourcePlace place) {
        return definition(std::move(place), take_typedef(scanner_));
    }
    Result<> definition(SourcePlace place, Result<std::string> text) {
        if (!text) {
            return std::unexpected(text.error());
        }
        component_.structures.push_back({std::move(place), std::move(*text)});
        return end();
    }

    Result<> paragraph(std::optional<Text> &into, SourcePlace place) {
        auto text = scanner_.take_string();
        if (!text) {
            return std::unexpected(text.error());
        }
        if (into) {
            into->text += "\n.PP\n" + *text;
        } else {
            into = Text{std::move(place), std::move(*text)};
        }
        return end();
    }

    Result<> description(SourcePlace place) { return paragraph(component_.description, std::move(place)); }
    Result<> examples(SourcePlace place) { return paragraph(component_.examples, std::move(place)); }
    Result<> notes(SourcePlace place) { return paragraph(component_.notes, std::move(place)); }
    Result<> see_also(SourcePlace place) { return paragraph(component_.see_also, std::move(place)); }
    Result<> license(SourcePlace place) { return paragraph(component_.license, std::move(place)); }
    Result<> author(SourcePlace place) {
        std::optional<Text> text;
        auto done = paragraph(text, std::move(place));
        if (text) {
            component_.authors.push_back(std::move(*text));
        }
        return done;
    }

    void take_code() {
        // Text after ;; on its line belongs to the code, so that columns are correct.
        component_.has_code = true;
        component_.code_line = scanner_.line();
        component_.code = std::string(text_.substr(scanner_.offset()));
    }

    std::string_view text_;
    Scanner scanner_;
    diagnostics::Sink &sink_;
    Component component_;
};

}  // namespace

Component parse(std::string_view text, const std::string &file, diagnostics::Sink &sink) {
    constexpr std::string_view BYTE_ORDER_MARK = "\xef\xbb\xbf";
    if (text.starts_with(BYTE_ORDER_MARK)) {
        text.remove_prefix(BYTE_ORDER_MARK.size());
    }
    return Parser(text, file, sink).run();
}

}  // namespace mw::halcompile
