"""Feedback in Spanish."""

from __future__ import annotations

from collections.abc import Mapping

SPANISH: Mapping[str, str] = {
    # Verdicts
    "correct": "Correcto.",
    "incorrect": "Incorrecto.",
    "missing-unit": "Falta la unidad.",
    "not-gradable": "Esta respuesta no se puede calificar: la tolerancia es más fina que la precisión del valor de "
    "referencia.",
    "unreadable": "Esta respuesta no se puede leer.",
    "figure-unknown": "No se puede evaluar: la pregunta no tiene esa magnitud. Avise al equipo del curso.",
    "carried": "No es el valor esperado, pero es coherente con su resultado anterior.",
    "several": "Cada uno de los errores siguientes conduce a este valor.",
    "sensitive": "Compare {name}: el valor mismo está tan cerca de una constante que apenas muestra el error.",
    # Units
    "unit-malformed": "Escriba la unidad como producto de potencias de unidades, por ejemplo kg m^2/s^2.",
    "unit-unknown": "Esta unidad no se conoce.",
    "unit-other-kind": "Esta unidad corresponde a otra magnitud.",
    "unit-millisecond": "Esta unidad corresponde a otra magnitud: ms es el milisegundo; metro por segundo se "
    "escribe m/s.",
    "unit-with-offset": "Use una unidad cuya escala empiece en cero.",
    "unit-size": "Esta unidad es demasiado grande o demasiado pequeña.",
    # Entries that cannot be read
    "direction-in-words": "Indique el sentido con el signo del número, no con palabras.",
    "entry-empty": "La respuesta está vacía.",
    "entry-malformed": "Escriba un número con su unidad, por ejemplo 6,28 s.",
    "number-ambiguous": "{digits} puede significar {whole} o {decimal}. Escriba {whole} o {padded}.",
    "number-malformed": "Escriba el número con un solo separador decimal y, si separa los millares, en grupos de "
    "tres cifras.",
    "number-or-range": "{entry} puede ser un cálculo, un intervalo o un valor con su incertidumbre. Escriba el "
    "resultado como un solo número.",
    "power-of-ten": "Escriba las potencias de diez con ^, por ejemplo 2*10^-3.",
    "quotient-unclear": "Use paréntesis: 1/2π puede significar 1/(2π) o (1/2)π.",
    "list-malformed": "Escriba una lista de números, por ejemplo [1,5; 2; 3].",
    "name-unknown": "El problema no tiene ninguna magnitud llamada «{name}». Los nombres son: {names}.",
    "name-from-zero": "El problema no tiene ninguna magnitud llamada «{name}»: la numeración empieza en 1. Los "
    "nombres son: {names}.",
    "formula-malformed": "La fórmula está incompleta o contiene un signo no admitido. Escriba * entre los factores.",
    "formula-not-expected": "Aquí no es posible una fórmula: la respuesta no es un número.",
    "form-number": "Dé un solo número.",
    "form-word": "Dé una de las palabras del problema, o true o false.",
    "form-list": "Dé una lista de {count} números.",
    "form-rows": "Dé {rows} filas de {count} números.",
    # Formulas
    "formula-undefined": "La fórmula no tiene valor para tales números: revise las divisiones, las raíces y los "
    "logaritmos.",
    "formula-not-judged": "Aquí no se puede calificar una fórmula. Dé el número con su unidad.",
    "formula-at-one-place": "La fórmula da el valor correcto para estos números, pero no para otros.",
    "dimension": "Revise las dimensiones: la fórmula no tiene la dimensión de la magnitud.",
    "dimension-terms": "Revise las dimensiones: solo se suman o restan magnitudes de la misma dimensión.",
    "dimension-function": "Revise las dimensiones: el argumento de funciones como sin y exp es un número sin "
    "dimensión.",
    "dimension-exponent": "Revise las dimensiones: un exponente es un número sin dimensión.",
    # Samples
    "samples-until": "Las muestras son correctas hasta t = {until:.3g} s.",
    "samples-separatrix": "Las muestras son correctas hasta t = {until:.3g} s. Después se pierden en la separatriz: "
    "desde t = {crossed:.3g} s giran alrededor de otro eje.",
    "samples-of-solver": "Las muestras proceden de un método adaptativo ({method}) con tolerancia {tolerance:.0e}.",
    "samples-of-method": "Las muestras proceden del método {method} con un paso de {step:.6g} s.",
    "samples-rounded": "Las muestras son correctas en las cifras dadas, pero la tolerancia exige más cifras.",
    "axes-exchanged": "Los ejes {one} y {other} están intercambiados.",
    "axes-order": "Los ejes están en el orden {order}.",
    # Mistakes in any quantity
    "sign": "El valor absoluto es correcto. Revise el signo y qué sentido cuenta como positivo.",
    "factor-2": "Demasiado grande por un factor de 2.",
    "factor-half": "Demasiado pequeño por un factor de 2.",
    "factor-2-pi": "Demasiado grande por un factor de 2π: distinga radianes de vueltas, y frecuencia angular de "
    "frecuencia.",
    "factor-1-over-2-pi": "Demasiado pequeño por un factor de 2π: distinga radianes de vueltas, y frecuencia "
    "angular de frecuencia.",
    "degrees": "Su valor está en grados. Delo en radianes o indique la unidad.",
    "rpm": "Su valor está en revoluciones por minuto. Delo en rad/s o indique la unidad.",
    "factor-1000": "Hay un error de un factor 1000: revise los prefijos de las unidades.",
    "squared": "Ha dado el cuadrado de la magnitud.",
    "root": "Ha dado la raíz cuadrada de la magnitud.",
    "reciprocal": "Ha dado el inverso de la magnitud. Un periodo, por ejemplo, es el inverso de una frecuencia.",
    "permuted-axes": "Las componentes son correctas, pero están en otro orden. Conserve los ejes en los que se da "
    "el cuerpo.",
    "transposed-rotation": "Esta es la rotación inversa. La rotación debe llevar los ejes del cuerpo a los del "
    "espacio.",
    "scalar-last": "Aquí la parte escalar del cuaternión va en primer lugar.",
    # Mass and inertia
    "inertia-about-another-point": "Los momentos de inercia se refieren a otro punto. Un cuerpo libre gira "
    "alrededor de su centro de masas, esté donde esté el origen.",
    "parallel-axis": "Revise el teorema de Steiner: su término se suma una sola vez al pasar del centro de masas a "
    "otro punto.",
    "products-of-inertia-sign": "Revise los signos fuera de la diagonal: I_xy es menos la integral de x y dm.",
    "repeated-points-dropped": "Cada masa puntual cuenta, aunque dos estén en el mismo lugar.",
    "shell-for-solid": "Revise la forma: ¿el cuerpo es macizo, o es una capa delgada con la masa lejos del eje?",
    "diameter-for-radius": "Revise si cada longitud es un radio o un diámetro.",
    # Rotation
    "space-axes": "Estas son las componentes en los ejes del espacio. Las ecuaciones de Euler usan las componentes "
    "en los ejes del cuerpo.",
    "samples-off-by-one": "Las muestras son correctas, pero están desplazadas un paso de tiempo.",
    "samples-rate-over-axial-moment": "La velocidad de precesión es incorrecta: ha dividido la diferencia de los "
    "momentos de inercia entre el momento axial en lugar del transversal.",
    "time-scaled": "El movimiento es correcto, pero va demasiado rápido o demasiado lento. Revise la unidad de "
    "tiempo y los factores de la velocidad.",
    "period-for-flip-interval": "Distinga el periodo del intervalo entre dos vuelcos: un vuelco dura medio periodo.",
    "body-for-space-rate": "Distinga dos velocidades de precesión: la de la velocidad angular en el cuerpo y la del "
    "eje del cuerpo en el espacio.",
    "cones-exchanged": "Revise entre qué direcciones está el ángulo: la velocidad angular y el momento angular no "
    "tienen la misma dirección.",
    "rate-over-axial-moment": "Divida la diferencia de los momentos de inercia entre el momento transversal, como "
    "muestran las ecuaciones de Euler para las componentes transversales.",
    "moments-exchanged": "Revise qué momento de inercia corresponde al eje de simetría.",
    "symmetric-formula": "Ha usado la fórmula de un cuerpo simétrico, pero los tres momentos de inercia son distintos.",
    "ellipticity-root-of-moments": "La razón de los ejes no es la raíz cuadrada del cociente de los momentos de "
    "inercia, que son proporcionales a 2a² y a² + c².",
    "ellipticity-quotient-of-moments": "La razón de los ejes es la raíz cuadrada de (1 + e)/(1 - e), donde e es la "
    "diferencia relativa de los momentos de inercia.",
    "flattening-for-asymmetry": "Distinga el achatamiento, que describe la forma, de la asimetría de los momentos "
    "de inercia.",
    "solar-for-sidereal-day": "Distinga el día solar del día sidéreo: la Tierra da una vuelta en un día sidéreo.",
    "extreme-axis-unstable": "La rotación alrededor del eje de mayor o de menor momento de inercia es estable: una "
    "perturbación pequeña sigue siendo pequeña.",
    "middle-axis-stable": "La rotación alrededor del eje de momento de inercia intermedio es inestable: una "
    "perturbación pequeña crece.",
    "real-for-imaginary": "Revise el signo del cuadrado: determina si los valores propios son reales o imaginarios.",
    "euler-second-equation": "Revise los signos: las ecuaciones de Euler se obtienen unas de otras por permutación "
    "cíclica de 1, 2 y 3.",
    "derivative-for-state": "El método de Euler suma al valor anterior el producto del paso por la derivada.",
    "step-left-out": "La derivada debe multiplicarse por el paso.",
    # Scenes
    "inertia-left-out": "Tenga en cuenta los momentos de inercia: una polea con masa tiene tensiones distintas a "
    "cada lado, y un cuerpo que rueda avanza más despacio que uno que desliza.",
    "shafts-do-not-turn": "Los cilindros giran mientras la cuerda se desenrolla, y eso absorbe parte del trabajo de "
    "la gravedad.",
    "hoop-for-solid-shaft": "Revise el momento de inercia de los cilindros: ¿cilindro macizo o tubo delgado?",
    "rod-inertia-about-end": "M l²/3 es el momento de inercia respecto a un extremo de la varilla. Parta del "
    "momento respecto a su centro y use el teorema de Steiner.",
    "rod-depth-and-inertia": "Revise las dimensiones de la energía potencial, los triángulos semejantes que dan la "
    "profundidad del centro al soltarla y el punto respecto al que toma el momento de inercia.",
    "rod-depth": "Revise las dimensiones de la energía potencial y los triángulos semejantes que dan la profundidad "
    "del centro.",
    "rod-without-own-rotation": "La varilla también gira mientras su centro oscila: tenga en cuenta su propio "
    "momento de inercia.",
    "masses-exchanged": "Revise de qué lado está cada masa.",
    "sine-for-cosine": "Revise la componente del peso a lo largo de cada pendiente y desde qué línea se mide el "
    "ángulo.",
    "calculator-in-radians": "Los senos no corresponden a estos ángulos. ¿Está la calculadora en radianes en lugar "
    "de grados?",
    "without-gravity": "Revise las dimensiones: falta la aceleración de la gravedad.",
}
