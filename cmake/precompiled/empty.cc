// SPDX-License-Identifier: GPL-2.0-or-later
// A source for targets that only precompile headers.
int main() {
    return 0;
}
