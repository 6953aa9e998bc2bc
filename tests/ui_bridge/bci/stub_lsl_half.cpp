// A library that is not liblsl.
extern "C" double lsl_local_clock() { return 0; }
