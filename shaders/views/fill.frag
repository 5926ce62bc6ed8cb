// One colour: what a picture costs without its content.
out vec4 color;

void main() { color = vec4(0.5); }
