// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/c_declaration.hh"

#include <fmt/core.h>

namespace mw::halcompile {
namespace {

Result<std::string> take_dimensions(Scanner &scanner) {
    std::string size;
    while (scanner.accept("[")) {
        scanner.skip_blank();
        const auto one = scanner.take_expression("]");
        if (!one) {
            return one;
        }
        scanner.accept("]");
        scanner.skip_blank();
        size += (size.empty() ? "" : "][") + *one;
    }
    return size;
}

}  // namespace

Result<CDeclaration> take_c_declaration(Scanner &scanner) {
    const SourcePlace place = scanner.place();
    CDeclaration found;
    std::string last;
    while (scanner.peek() != '*') {
        std::string word = scanner.take_name();
        if (word.empty()) {
            break;
        }
        if (!last.empty()) {
            found.type += (found.type.empty() ? "" : " ") + last;
        }
        last = std::move(word);
        scanner.skip_blank();
    }
    if (scanner.peek() == '*') {
        found.type += (found.type.empty() ? "" : " ") + last;
        while (scanner.accept("*")) {
            found.stars += '*';
            scanner.skip_blank();
        }
        last = scanner.take_name();
        scanner.skip_blank();
    }
    found.name = std::move(last);
    if (found.type.empty() || found.name.empty()) {
        return fail("a C type and a name are expected here", place);
    }
    auto size = take_dimensions(scanner);
    if (!size) {
        return std::unexpected(size.error());
    }
    found.size = std::move(*size);
    return found;
}

Result<std::string> take_struct(Scanner &scanner) {
    const std::string tag = scanner.take_name();
    scanner.skip_blank();
    if (tag.empty()) {
        return fail("the name of the struct is expected here", scanner.place());
    }
    const auto body = scanner.take_braced();
    return body ? Result<std::string>(fmt::format("struct {} {{{}}};", tag, *body)) : body;
}

Result<std::string> take_typedef(Scanner &scanner) {
    auto before = scanner.take_expression(";{");
    if (!before || scanner.peek() != '{') {
        return before ? Result<std::string>("typedef " + *before + ";") : before;
    }
    const auto body = scanner.take_braced();
    if (!body) {
        return body;
    }
    const auto after = scanner.take_expression(";");
    return after ? Result<std::string>(fmt::format("typedef {} {{{}}} {};", *before, *body, *after)) : after;
}

}  // namespace mw::halcompile
