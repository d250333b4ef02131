// Taught by 29_emitters.
//
// The table that chooses one of many, each as often as its weight says.

// A column of the table: what part of it belongs to its own number, and whose the rest is.
struct Column {
    float own;
    uint other;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Columns { Column at[]; };
