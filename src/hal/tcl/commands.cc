// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/commands.hh"

#include <algorithm>
#include <array>

#include "base/text.hh"
#include "hal/tcl/interpreter.hh"

namespace mw::hal::tcl {

namespace {

/// Commands whose names have another meaning in Tcl: only with the prefix `hal`.
constexpr std::array<std::string_view, 5> TAKEN = {"gets", "list", "exit", "quit", "source"};
/// Commands that print their result. Other commands return it, also `hal show`.
constexpr std::array<std::string_view, 3> PRINTING = {"show", "save", "help"};

template <std::size_t N>
bool isOneOf(const std::array<std::string_view, N> &words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string text_of(Tcl_Obj *object) {
    int length = 0;
    const char *text = Tcl_GetStringFromObj(object, &length);
    return {text, static_cast<std::size_t>(length)};
}

void set_result(Tcl_Interp *interpreter, const std::string &text) {
    Tcl_SetObjResult(interpreter, Tcl_NewStringObj(text.data(), static_cast<int>(text.size())));
}

int failed(Tcl_Interp *interpreter, const Error &error) {
    set_result(interpreter, error.str());
    return TCL_ERROR;
}

/// The value of an expression, as text; other texts are returned unchanged.
std::string evaluated(Tcl_Interp *interpreter, const std::string &text) {
    Tcl_InterpState before = Tcl_SaveInterpState(interpreter, TCL_OK);
    Tcl_Obj *value = nullptr;
    std::string result = text;
    Tcl_Obj *expression = Tcl_NewStringObj(text.data(), static_cast<int>(text.size()));
    Tcl_IncrRefCount(expression);
    if (Tcl_ExprObj(interpreter, expression, &value) == TCL_OK) {
        result = text_of(value);
        Tcl_DecrRefCount(value);
    }
    Tcl_DecrRefCount(expression);
    (void)Tcl_RestoreInterpState(interpreter, before);
    return result;
}

/// The words of an INI value, which Tcl treats as a list of one element.
std::vector<std::string> parts_of(const std::string &value) {
    int count = 0;
    const char **elements = nullptr;
    if (Tcl_SplitList(nullptr, value.c_str(), &count, &elements) != TCL_OK) {
        return split_words(value);
    }
    std::vector<std::string> parts;
    for (int i = 0; i < count; ++i) {
        const std::vector<std::string> words = split_words(elements[i]);
        parts.insert(parts.end(), words.begin(), words.end());
    }
    Tcl_Free(reinterpret_cast<char *>(elements));
    return parts;
}

/// How a command was called: `hal show ...` returns its result, `show ...` prints it.
enum class Asked { BY_NAME, THROUGH_HAL };

int run(Tcl_Interp *interpreter, script::Session &session, std::vector<std::string> words, Asked asked) {
    if (words[0] == "loadrt" && words.size() > 1) {
        // $::KINS(KINEMATICS) is one word in Tcl: module and parameters.
        const std::vector<std::string> parts = parts_of(words[1]);
        words.erase(words.begin() + 1);
        words.insert(words.begin() + 1, parts.begin(), parts.end());
    }
    const bool setting = words[0] == "setp" || words[0] == "sets";
    if (setting && words.size() == 3) {
        words[2] = evaluated(interpreter, words[2]);
    }
    Result<std::string> answer = session.call(words);
    if (!answer) {
        return failed(interpreter, answer.error());
    }
    const bool is_result = asked == Asked::THROUGH_HAL && words[0] == "show";
    if (isOneOf(PRINTING, words[0]) && !is_result) {
        session.output().data(*answer);
        answer->clear();
    }
    if (is_result && answer->ends_with("\n\n")) {
        answer->pop_back();
    }
    while (!is_result && !answer->empty() && answer->back() == '\n') {
        answer->pop_back();
    }
    set_result(interpreter, *answer);
    return TCL_OK;
}

script::Session &session_of(ClientData data) {
    return *static_cast<script::Session *>(data);
}

std::vector<std::string> words_of(int count, Tcl_Obj *const objects[], int from) {
    std::vector<std::string> words;
    for (int i = from; i < count; ++i) {
        words.push_back(text_of(objects[i]));
    }
    return words;
}

int run_named(ClientData data, Tcl_Interp *interpreter, int count, Tcl_Obj *const objects[]) {
    std::vector<std::string> words = words_of(count, objects, 0);
    // A command may be called as ::net.
    words[0] = words[0].substr(words[0].rfind(':') + 1);
    return run(interpreter, session_of(data), std::move(words), Asked::BY_NAME);
}

std::string command_list() {
    std::vector<std::string> names;
    for (const script::CommandSpec &spec : script::commands()) {
        names.emplace_back(spec.name);
    }
    std::sort(names.begin(), names.end());
    std::string text;
    for (const std::string &name : names) {
        text += (text.empty() ? "" : " ") + name;
    }
    return text;
}

int run_hal(ClientData data, Tcl_Interp *interpreter, int count, Tcl_Obj *const objects[]) {
    if (count < 2) {
        Tcl_WrongNumArgs(interpreter, 1, objects, "command ?word ...?");
        return TCL_ERROR;
    }
    std::vector<std::string> words = words_of(count, objects, 1);
    if (words[0] == "--commands") {
        set_result(interpreter, command_list());
        return TCL_OK;
    }
    if (words[0] == "--pass") {
        const script::Pass pass = session_of(data).options().pass;
        set_result(interpreter, pass == script::Pass::ALL ? "" : pass == script::Pass::LOADS ? "0" : "1");
        return TCL_OK;
    }
    return run(interpreter, session_of(data), std::move(words), Asked::THROUGH_HAL);
}

/// A read of $::SECTION(ITEM) marks the entry as used.
char *note_use(ClientData data, Tcl_Interp *, const char *section, const char *item, int) {
    if (item != nullptr) {
        (void)static_cast<const script::IniLookup *>(data)->find(section, item);
    }
    return nullptr;
}

/// Lets Tcl source HAL files as well as Tcl files.
constexpr const char *SOURCE_HAL_FILES = R"(
rename source ::hal_tcl_source
proc source {args} {
    set file [lindex $args end]
    if {[llength $args] == 1 && ([string match *.hal $file] || [string match LIB:* $file])} {
        return [hal source $file]
    }
    uplevel 1 [linsert $args 0 ::hal_tcl_source]
}
)";

/// Scripts check for this namespace to detect two passes.
constexpr const char *TWO_PASSES = "namespace eval ::tp { proc passnumber {} { return [hal --pass] } }";

}  // namespace

void add_commands(Tcl_Interp *interpreter, script::Session &session) {
    for (const script::CommandSpec &spec : script::commands()) {
        if (!isOneOf(TAKEN, spec.name)) {
            Tcl_CreateObjCommand(interpreter, std::string(spec.name).c_str(), run_named, &session, nullptr);
        }
    }
    Tcl_CreateObjCommand(interpreter, "hal", run_hal, &session, nullptr);
    (void)Tcl_Eval(interpreter, SOURCE_HAL_FILES);
    if (session.options().pass != script::Pass::ALL) {
        (void)Tcl_Eval(interpreter, TWO_PASSES);
    }
}

void add_ini(Tcl_Interp *interpreter, const script::IniLookup &ini) {
    for (const std::string &section : ini.sections()) {
        for (const std::string &item : ini.names(section)) {
            Tcl_Obj *values = Tcl_NewListObj(0, nullptr);
            for (const std::string &value : ini.values(section, item)) {
                Tcl_ListObjAppendElement(nullptr, values,
                                         Tcl_NewStringObj(value.data(), static_cast<int>(value.size())));
            }
            Tcl_SetVar2Ex(interpreter, section.c_str(), item.c_str(), values, TCL_GLOBAL_ONLY);
        }
        Tcl_TraceVar2(interpreter, section.c_str(), nullptr, TCL_GLOBAL_ONLY | TCL_TRACE_READS, note_use,
                      const_cast<script::IniLookup *>(&ini));
    }
}

}  // namespace mw::hal::tcl
