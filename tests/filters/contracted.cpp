// Compiled with contraction, this program must end before main begins.

#include "touchstone/filters/expressions.hpp"

int main() { return 0; }
