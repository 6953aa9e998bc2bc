// The terminal at standard input, key by key.
#pragma once

namespace beckon {

/// Each key at once and unseen, until RestoreTerminal or the process's exit by whatever return or
/// exit(). Ctrl-C still ends the program; what would leave it without restoring (Ctrl-\, Ctrl-Z) is
/// off. Nothing where standard input is no terminal.
void MakeTerminalRaw();

/// As it was before MakeTerminalRaw.
void RestoreTerminal();

}  // namespace beckon
