"""Feedback in German."""

from __future__ import annotations

from collections.abc import Mapping

GERMAN: Mapping[str, str] = {
    # Verdicts
    "correct": "Richtig.",
    "incorrect": "Nicht richtig.",
    "missing-unit": "Die Einheit fehlt.",
    "not-gradable": "Diese Antwort lässt sich nicht bewerten: Die Toleranz ist enger, als der Vergleichswert "
    "bekannt ist.",
    "unreadable": "Diese Eingabe ist nicht lesbar.",
    "figure-unknown": "Das kann nicht bewertet werden: Die Aufgabe hat keine solche "
    "Größe. Bitte der Kursleitung melden.",
    "carried": "Nicht der erwartete Wert, aber aus dem vorherigen Ergebnis richtig berechnet (Folgefehler).",
    "several": "Jeder der folgenden Fehler führt auf diesen Wert.",
    "sensitive": "Vergleichen Sie {name}: Der Wert selbst liegt so nahe an einer Konstanten, dass der Fehler kaum "
    "auffällt.",
    # Units
    "unit-malformed": "Schreiben Sie die Einheit als Produkt von Potenzen, zum Beispiel kg m^2/s^2.",
    "unit-unknown": "Diese Einheit ist nicht bekannt.",
    "unit-other-kind": "Diese Einheit gehört zu einer anderen Größe.",
    "unit-millisecond": "Diese Einheit gehört zu einer anderen Größe: ms sind Millisekunden, Meter pro Sekunde sind "
    "m/s.",
    "unit-with-offset": "Verwenden Sie eine Einheit, deren Skala bei null beginnt.",
    "unit-size": "Diese Einheit ist zu groß oder zu klein.",
    # Entries that cannot be read
    "direction-in-words": "Geben Sie die Richtung durch das Vorzeichen der Zahl an, nicht in Worten.",
    "entry-empty": "Die Eingabe ist leer.",
    "entry-malformed": "Schreiben Sie eine Zahl mit ihrer Einheit, zum Beispiel 6,28 s.",
    "number-ambiguous": "{digits} kann {whole} oder {decimal} bedeuten. Schreiben Sie {whole} oder {padded}.",
    "number-malformed": "Schreiben Sie die Zahl mit einem Dezimalzeichen und, falls Sie Tausender trennen, in "
    "Dreiergruppen.",
    "number-or-range": "{entry} kann eine Rechnung, ein Bereich oder ein Wert mit Unsicherheit sein. Geben Sie das "
    "Ergebnis als eine einzige Zahl an.",
    "power-of-ten": "Schreiben Sie Zehnerpotenzen mit ^, zum Beispiel 2*10^-3.",
    "quotient-unclear": "Setzen Sie Klammern: 1/2π kann 1/(2π) oder (1/2)π bedeuten.",
    "list-malformed": "Schreiben Sie eine Liste von Zahlen, zum Beispiel [1,5; 2; 3].",
    "name-unknown": "In der Aufgabe gibt es keine Größe „{name}“. Die Namen sind: {names}.",
    "name-from-zero": "In der Aufgabe gibt es keine Größe „{name}“: Die Zählung beginnt bei 1. Die Namen sind: "
    "{names}.",
    "formula-malformed": "Die Formel ist unvollständig oder enthält ein unzulässiges Zeichen. "
    "Schreiben Sie * zwischen Faktoren.",
    "formula-not-expected": "Eine Formel ist hier nicht möglich: Gefragt ist keine einzelne Zahl.",
    "form-number": "Geben Sie eine einzelne Zahl an.",
    "form-word": "Geben Sie eines der Wörter der Aufgabe oder true oder false an.",
    "form-list": "Geben Sie eine Liste von {count} Zahlen an.",
    "form-rows": "Geben Sie {rows} Zeilen mit je {count} Zahlen an.",
    # Formulas
    "formula-undefined": "Die Formel hat für solche Zahlen keinen Wert: Prüfen Sie Divisionen, Wurzeln und "
    "Logarithmen.",
    "formula-not-judged": "Eine Formel lässt sich hier nicht bewerten. Geben Sie die Zahl mit ihrer Einheit an.",
    "formula-at-one-place": "Die Formel ergibt für diese Zahlen den richtigen Wert, für andere aber nicht.",
    "dimension": "Prüfen Sie die Dimensionen: Die Formel hat nicht die Dimension der gesuchten Größe.",
    "dimension-terms": "Prüfen Sie die Dimensionen: Nur Größen gleicher Dimension lassen sich addieren oder "
    "subtrahieren.",
    "dimension-function": "Prüfen Sie die Dimensionen: Das Argument von Funktionen wie sin und exp ist eine reine "
    "Zahl.",
    "dimension-exponent": "Prüfen Sie die Dimensionen: Ein Exponent ist eine reine Zahl.",
    # Samples
    "samples-until": "Die Werte sind bis t = {until:.3g} s richtig.",
    "samples-separatrix": "Die Werte sind bis t = {until:.3g} s richtig. Danach gehen sie an der Separatrix "
    "verloren: Ab t = {crossed:.3g} s umkreisen sie eine andere Achse.",
    "samples-of-solver": "Die Werte stammen aus einem adaptiven Verfahren ({method}) mit der Toleranz {tolerance:.0e}.",
    "samples-of-method": "Die Werte stammen aus dem Verfahren {method} mit der Schrittweite {step:.6g} s.",
    "samples-rounded": "Die Werte sind in den angegebenen Stellen richtig; die Toleranz verlangt aber mehr Stellen.",
    "axes-exchanged": "Die Achsen {one} und {other} sind vertauscht.",
    "axes-order": "Die Achsen stehen in der Reihenfolge {order}.",
    # Mistakes in any quantity
    "sign": "Der Betrag stimmt. Prüfen Sie das Vorzeichen und welche Richtung positiv zählt.",
    "factor-2": "Um den Faktor 2 zu groß.",
    "factor-half": "Um den Faktor 2 zu klein.",
    "factor-2-pi": "Um den Faktor 2π zu groß: Unterscheiden Sie Bogenmaß und Umdrehungen, Kreisfrequenz und Frequenz.",
    "factor-1-over-2-pi": "Um den Faktor 2π zu klein: Unterscheiden Sie Bogenmaß und Umdrehungen, Kreisfrequenz und "
    "Frequenz.",
    "degrees": "Ihr Wert ist in Grad angegeben. Rechnen Sie ins Bogenmaß um, oder nennen Sie die Einheit.",
    "rpm": "Ihr Wert ist in Umdrehungen pro Minute angegeben. Rechnen Sie in rad/s um, oder nennen Sie die Einheit.",
    "factor-1000": "Um den Faktor 1000 falsch: Prüfen Sie die Vorsätze der Einheiten.",
    "squared": "Sie haben das Quadrat der Größe angegeben.",
    "root": "Sie haben die Quadratwurzel der Größe angegeben.",
    "reciprocal": "Sie haben den Kehrwert der Größe angegeben. Eine Periode ist zum Beispiel der Kehrwert einer "
    "Frequenz.",
    "permuted-axes": "Die Komponenten stimmen, aber ihre Reihenfolge nicht. Behalten Sie die Achsen bei, in denen "
    "der Körper gegeben ist.",
    "transposed-rotation": "Das ist die inverse Drehung. Gesucht ist die Drehung von den körperfesten in die "
    "raumfesten Achsen.",
    "scalar-last": "Der Skalarteil des Quaternions steht hier an erster Stelle.",
    # Mass and inertia
    "inertia-about-another-point": "Die Trägheitsmomente beziehen sich auf einen anderen Punkt. Ein freier Körper "
    "dreht sich um seinen Schwerpunkt, wo auch immer der Ursprung liegt.",
    "parallel-axis": "Prüfen Sie den Satz von Steiner: Vom Schwerpunkt zu einem anderen Punkt wird der "
    "Steiner-Anteil einmal addiert.",
    "products-of-inertia-sign": "Prüfen Sie die Vorzeichen außerhalb der Diagonale: I_xy ist minus das Integral "
    "über x y dm.",
    "repeated-points-dropped": "Jede Punktmasse zählt, auch wenn zwei am selben Ort sind.",
    "shell-for-solid": "Prüfen Sie die Form: Ist der Körper massiv, oder ist er eine dünne Schale mit der Masse "
    "weit außen?",
    "diameter-for-radius": "Prüfen Sie bei jeder Länge, ob sie ein Radius oder ein Durchmesser ist.",
    # Rotation
    "space-axes": "Das sind die Komponenten in raumfesten Achsen. Die Eulerschen Gleichungen gelten für die "
    "Komponenten in körperfesten Achsen.",
    "samples-off-by-one": "Die Werte sind richtig, aber um einen Zeitschritt verschoben.",
    "samples-rate-over-axial-moment": "Die Präzessionsrate ist falsch: Die Differenz der Trägheitsmomente wurde "
    "durch das axiale statt durch das transversale Trägheitsmoment geteilt.",
    "time-scaled": "Die Bewegung ist richtig, läuft aber zu schnell oder zu langsam. Prüfen Sie die Zeiteinheit und "
    "die Faktoren in der Rate.",
    "period-for-flip-interval": "Unterscheiden Sie die Periode vom Abstand zweier Überschläge: Ein Überschlag ist "
    "eine halbe Periode.",
    "body-for-space-rate": "Unterscheiden Sie zwei Raten: die der Winkelgeschwindigkeit im Körper und die der "
    "Körperachse im Raum.",
    "cones-exchanged": "Prüfen Sie, zwischen welchen Richtungen der Winkel liegt: Winkelgeschwindigkeit und "
    "Drehimpuls sind verschieden gerichtet.",
    "rate-over-axial-moment": "Die Differenz der Trägheitsmomente ist durch das transversale Trägheitsmoment zu "
    "teilen, wie die Eulerschen Gleichungen für die transversalen Komponenten zeigen.",
    "moments-exchanged": "Prüfen Sie, welches Trägheitsmoment zur Symmetrieachse gehört.",
    "symmetric-formula": "Sie haben die Formel für einen symmetrischen Körper verwendet; die drei Trägheitsmomente "
    "sind aber verschieden.",
    "ellipticity-root-of-moments": "Das Achsenverhältnis ist nicht die Quadratwurzel aus dem Verhältnis der "
    "Trägheitsmomente, die proportional zu 2a² und a² + c² sind.",
    "ellipticity-quotient-of-moments": "Das Achsenverhältnis ist die Quadratwurzel aus (1 + e)/(1 - e); dabei ist e "
    "die relative Differenz der Trägheitsmomente.",
    "flattening-for-asymmetry": "Unterscheiden Sie die Abplattung, die die Form beschreibt, von der Asymmetrie der "
    "Trägheitsmomente.",
    "solar-for-sidereal-day": "Unterscheiden Sie Sonnentag und Sterntag: Die Erde dreht sich in einem Sterntag einmal.",
    "extreme-axis-unstable": "Die Drehung um die Achse mit dem größten oder kleinsten Trägheitsmoment ist stabil: "
    "Eine kleine Störung bleibt klein.",
    "middle-axis-stable": "Die Drehung um die Achse mit dem mittleren Trägheitsmoment ist instabil: Eine kleine "
    "Störung wächst.",
    "real-for-imaginary": "Prüfen Sie das Vorzeichen des Quadrats: Es entscheidet, ob die Eigenwerte reell oder "
    "imaginär sind.",
    "euler-second-equation": "Prüfen Sie die Vorzeichen: Die Eulerschen Gleichungen gehen durch zyklisches "
    "Vertauschen von 1, 2 und 3 auseinander hervor.",
    "derivative-for-state": "Das Euler-Verfahren addiert die Schrittweite mal die Ableitung zum vorherigen Wert.",
    "step-left-out": "Die Ableitung muss mit der Schrittweite multipliziert werden.",
    # Scenes
    "inertia-left-out": "Berücksichtigen Sie die Trägheitsmomente: An einer Rolle mit Masse sind die Fadenkräfte "
    "auf beiden Seiten verschieden, und ein rollender Körper ist langsamer als ein gleitender.",
    "shafts-do-not-turn": "Die Wellen drehen sich, während der Faden abrollt; das braucht einen Teil der Arbeit der "
    "Schwerkraft.",
    "hoop-for-solid-shaft": "Prüfen Sie das Trägheitsmoment der Wellen: Vollzylinder oder dünnes Rohr?",
    "rod-inertia-about-end": "M l²/3 ist das Trägheitsmoment um ein Ende des Stabes. Gehen Sie vom Trägheitsmoment "
    "um den Mittelpunkt aus, und verwenden Sie den Satz von Steiner.",
    "rod-depth-and-inertia": "Prüfen Sie die Dimensionen der potentiellen Energie, die ähnlichen Dreiecke für die "
    "Tiefe des Mittelpunkts beim Loslassen und den Punkt, auf den sich das Trägheitsmoment bezieht.",
    "rod-depth": "Prüfen Sie die Dimensionen der potentiellen Energie und die ähnlichen Dreiecke für die Tiefe des "
    "Mittelpunkts.",
    "rod-without-own-rotation": "Der Stab dreht sich auch, während sein Mittelpunkt schwingt: Berücksichtigen Sie "
    "sein eigenes Trägheitsmoment.",
    "masses-exchanged": "Prüfen Sie, welche Masse auf welcher Seite ist.",
    "sine-for-cosine": "Prüfen Sie die Komponente der Gewichtskraft entlang jeder Schräge und von welcher Linie aus "
    "der Winkel gemessen wird.",
    "calculator-in-radians": "Die Sinuswerte passen nicht zu diesen Winkeln. Steht der Taschenrechner auf Bogenmaß "
    "statt auf Grad?",
    "without-gravity": "Prüfen Sie die Dimensionen: Die Fallbeschleunigung fehlt.",
}
