// SPDX-License-Identifier: GPL-2.0-or-later
// rs274: interprets a program without a machine and prints its canon calls.
#include "gcode/analysis/rs274.hh"

#include <unistd.h>

#include <clocale>
#include <cstdio>
#include <cstring>

#include "base/language/language.hh"
#include "base/own_place.hh"

namespace {

constexpr char USAGE[] = "Usage: rs274 [-t tool.tbl] [-v parameters.var] [-i machine.ini] [-n 0|1|2] [-b] "
                         "[-s] [-g] [-T] [-l level] [-p interp.so]\n"
                         "             [input file [output file]]\n\n"
                         "    -t: the tool table file (default: three built-in tools)\n"
                         "    -v: the parameter file, read at the start and written at the end\n"
                         "    -i: the INI file (default: none)\n"
                         "    -n: after an error: 0 continue, 1 read MDI lines, 2 stop (default)\n"
                         "    -b: switch block delete on (lines with / are skipped)\n"
                         "    -s: show place and callers of errors\n"
                         "    -g: go: batch mode\n"
                         "    -T, -l level: accepted for compatibility\n"
                         "    -p interp.so: another interpreter, a plug-in\n";

int usage(const char *message, int status) {
    if (*message != '\0') {
        mw::language::tell(message);
    }
    std::fputs(mw::language::shown(USAGE).c_str(), status == 0 ? stdout : stderr);
    return status;
}

}  // namespace

int main(int argc, char **argv) {
    mw::tell_when_memory_ends();
    using Options = mw::gcode::StandaloneOptions;
    Options options;
    if (argc > 1 && std::strcmp(argv[1], "--help") == 0) {
        return usage("", 0);
    }
    int option = 0;
    while ((option = getopt(argc, argv, "p:t:v:n:bsgi:Tl:h")) != -1) {
        switch (option) {
        case 'p': options.plugin = optarg; break;
        case 't': options.tool_file = optarg; break;
        case 'v': options.var_file = optarg; break;
        case 'i': options.ini_file = optarg; break;
        case 'n':
            if (std::strlen(optarg) != 1 || optarg[0] < '0' || optarg[0] > '2') {
                return usage("rs274: -n needs 0, 1 or 2", 2);
            }
            options.on_error = static_cast<Options::OnError>(optarg[0] - '0');
            break;
        case 'b': options.isBlockDelete = !options.isBlockDelete; break;
        case 's': options.stack_shown = !options.stack_shown; break;
        case 'g': options.is_batch = !options.is_batch; break;
        case 'T':
        case 'l': break;
        case 'h': return usage("", 0);
        default: return usage("", 2);
        }
    }
    if (optind < argc) {
        options.input = argv[optind++];
    }
    if (optind < argc) {
        options.output = argv[optind++];
    }
    if (optind < argc) {
        return usage("rs274: too many files", 2);
    }
    return mw::gcode::run_standalone(options);
}
