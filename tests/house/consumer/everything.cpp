// Uses nothing, because its linker command takes every object of every room.
int main() {}
