"""One archive of everything that a server keeps, made while it flies, and put back on an empty one."""
