// SPDX-License-Identifier: GPL-2.0-or-later
// message_reference: prints docs/messages.md, with --nml docs/nml_messages.md. A tool of the build, not
// installed.
#include <cstdio>
#include <string>
#include <string_view>

#include "msgs/reference.hh"
#include "nml/message/sender.hh"

int main(int count, char **words) {
    const bool isNml = count == 2 && std::string_view(words[1]) == "--nml";
    if (count > 1 && !isNml) {
        std::fputs("usage: message_reference [--nml]\n", stderr);
        return 2;
    }
    const std::string page = isNml ? mw::nml::nml_reference_page() : mw::msgs::reference_page();
    return std::fputs(page.c_str(), stdout) < 0 ? 1 : 0;
}
