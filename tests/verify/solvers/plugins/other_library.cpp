/// \file
/// A library that is not a plugin.

extern "C" int answer_to_everything() { return 42; }
