// Compiled with contraction, this program must end before main begins.

#include "filters/expressions.hpp"

int main() { return 0; }
