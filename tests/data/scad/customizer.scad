/* [Size] */
// Width in mm
width = 40; // [10:100]
name = "box"; // [box, lid]
flags = [1, 2]; // a vector
/* [Hidden] */
secret = 5;
echo(width, name, flags, secret);
