// Exponential depth fog: a colour by distance alone, whatever the lights are.

COLOUR rival_airlight(Configuration c, int steps)
{
    return 1.0 - exp(-c.extinction * c.extent);
}
