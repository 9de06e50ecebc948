// sim/main.cpp
// The one program: picks a command and runs it.
int main() {
    return 0;
}
