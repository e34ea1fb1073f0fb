// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tcl/source_limits.hh"

#include <vector>

#include <fmt/format.h>

#include "base/atomic_file.hh"

namespace mw::hal::tcl {
namespace {

constexpr int MOST_NESTED = 1000;
constexpr const char *SOURCE = "::tcl::unlimited_source";

bool isNameCharacter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == ':';
}

int run_source(ClientData /*data*/, Tcl_Interp *interpreter, int count, Tcl_Obj *const objects[]) {
    const std::string path = Tcl_GetString(objects[count - 1]);
    if (const auto checked = check_nesting_of_file(path); count > 1 && !checked) {
        Tcl_SetObjResult(interpreter, Tcl_NewStringObj(checked.error().str().c_str(), -1));
        return TCL_ERROR;
    }
    std::vector<Tcl_Obj *> words(objects, objects + count);
    words[0] = Tcl_NewStringObj(SOURCE, -1);
    Tcl_IncrRefCount(words[0]);
    const int status = Tcl_EvalObjv(interpreter, count, words.data(), 0);
    Tcl_DecrRefCount(words[0]);
    return status;
}

}  // namespace

Result<> check_nesting(std::string_view script, const std::string &path) {
    int commands = 0, names = 0, line = 1;  // open brackets: [, and $name(
    bool in_name = false;                   // after a $
    for (std::size_t at = 0; at < script.size(); ++at) {
        const char c = script[at];
        if (c == '\\' && at + 1 < script.size()) {
            ++at;
            in_name = false;
            line += script[at] == '\n' ? 1 : 0;
            continue;
        }
        commands += c == '[' ? 1 : c == ']' && commands > 0 ? -1 : 0;
        names += c == '(' && in_name ? 1 : c == ')' && names > 0 ? -1 : 0;
        in_name = c == '$' || (in_name && isNameCharacter(c));
        line += c == '\n' ? 1 : 0;
        if (commands + names > MOST_NESTED) {
            return fail(fmt::format("more than {} '{}' are open in one another", MOST_NESTED, c),
                        {path, line, 0});
        }
    }
    return {};
}

Result<> check_nesting_of_file(const std::string &path) {
    const auto script = read_file(path);
    return script ? check_nesting(*script, path) : Result<>{};
}

void add_source_limits(Tcl_Interp *interpreter) {
    (void)Tcl_Eval(interpreter, fmt::format("rename ::source {}", SOURCE).c_str());
    Tcl_CreateObjCommand(interpreter, "source", run_source, nullptr, nullptr);
}

}  // namespace mw::hal::tcl
