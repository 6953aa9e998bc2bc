// beckon: what a person does with the whole system: try it, check a machine, run it, record,
// replay.
#include "tools/beckon/commands.h"

int main(int argc, char** argv) { return beckon::tool::RunBeckon(argc, argv); }
