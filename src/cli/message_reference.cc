// SPDX-License-Identifier: GPL-2.0-or-later
// message_reference: prints docs/messages.md, with --nml docs/nml_messages.md. A tool of the build, not
// installed.
#include <cstdio>
#include <string>
#include <string_view>

#include "msgs/reference.hh"
#include "nml/message/sender.hh"

int main(int count, char **words) {
    constexpr const char *USAGE = "usage: message_reference [--nml]\n"
                                  "Prints docs/messages.md, or docs/nml_messages.md.\n";
    const std::string_view word = count == 2 ? words[1] : "";
    if (word == "--help") {
        return std::fputs(USAGE, stdout) < 0 ? 1 : 0;
    }
    if (count > 1 && word != "--nml") {
        std::fputs(USAGE, stderr);
        return 2;
    }
    const std::string page = word == "--nml" ? mw::nml::nml_reference_page() : mw::msgs::reference_page();
    return std::fputs(page.c_str(), stdout) < 0 ? 1 : 0;
}
