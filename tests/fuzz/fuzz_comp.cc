// SPDX-License-Identifier: GPL-2.0-or-later
// Arbitrary text as a .comp file: parser, checker and both emitters; arbitrary bytes as an object file.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/diagnostics/sink.hh"
#include "hal/halcompile/checker.hh"
#include "hal/halcompile/emit_c.hh"
#include "hal/halcompile/emit_man.hh"
#include "hal/halcompile/object_file.hh"
#include "hal/halcompile/parser.hh"
#include "hal/halcompile/toolchain.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char *>(data), size);
    mw::diagnostics::Sink sink;
    const mw::halcompile::Component component = mw::halcompile::parse(text, "x.comp", sink);
    mw::halcompile::check(component, "x", sink);
    if (!sink.hasErrors()) {
        (void)mw::halcompile::emit_c(component);
    }
    (void)mw::halcompile::emit_man(component);
    (void)mw::halcompile::look_at_object(text, "x.o");
    (void)mw::halcompile::split_shell_words(std::string(text));
    return 0;
}
