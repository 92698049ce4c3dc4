// Empty: the targets that precompile the header need a source.
